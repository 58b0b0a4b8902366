; A lift with a constant, types, negative preconditions and inequality.
(define (domain lift)
  (:requirements :strips :typing :negative-preconditions :equality)
  (:types floor - object person - object visitor - person)
  (:constants ground - floor)
  (:predicates (above ?high ?low - floor) (lift-at ?f - floor) (waits ?p - person ?f - floor)
               (wants ?p - person ?f - floor) (boarded ?p - person) (served ?p - person)
               (full))
  (:action up
    :parameters (?from ?to - floor)
    :precondition (and (lift-at ?from) (above ?to ?from))
    :effect (and (lift-at ?to) (not (lift-at ?from))))
  (:action down
    :parameters (?from ?to - floor)
    :precondition (and (lift-at ?from) (above ?from ?to))
    :effect (and (lift-at ?to) (not (lift-at ?from))))
  (:action home
    :parameters (?from - floor)
    :precondition (and (lift-at ?from) (not (= ?from ground)) (not (full)))
    :effect (and (lift-at ground) (not (lift-at ?from))))
  (:action board
    :parameters (?p - person ?f - floor)
    :precondition (and (lift-at ?f) (waits ?p ?f) (not (boarded ?p)) (not (served ?p)) (not (full)))
    :effect (and (boarded ?p) (full) (not (waits ?p ?f))))
  (:action leave
    :parameters (?p - person ?f - floor)
    :precondition (and (lift-at ?f) (boarded ?p) (wants ?p ?f))
    :effect (and (served ?p) (not (boarded ?p)) (not (full)))))
