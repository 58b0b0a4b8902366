; A robot with two grippers carries balls; the kinds of things are unary predicates.
(define (domain gripper)
  (:predicates (room ?r) (ball ?b) (gripper ?g) (robot-in ?r) (in ?b ?r) (free ?g) (holds ?g ?b))
  (:action go
    :parameters (?from ?to)
    :precondition (and (room ?from) (room ?to) (robot-in ?from))
    :effect (and (robot-in ?to) (not (robot-in ?from))))
  (:action take
    :parameters (?b ?r ?g)
    :precondition (and (ball ?b) (room ?r) (gripper ?g) (in ?b ?r) (robot-in ?r) (free ?g))
    :effect (and (holds ?g ?b) (not (in ?b ?r)) (not (free ?g))))
  (:action leave
    :parameters (?b ?r ?g)
    :precondition (and (ball ?b) (room ?r) (gripper ?g) (holds ?g ?b) (robot-in ?r))
    :effect (and (in ?b ?r) (free ?g) (not (holds ?g ?b)))))
