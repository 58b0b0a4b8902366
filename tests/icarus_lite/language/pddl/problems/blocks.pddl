; A table of blocks and one hand, untyped, as the oldest benchmarks are.
(define (domain blocks)
  (:requirements :strips)
  (:predicates (on ?above ?below) (on-table ?block) (clear ?block) (hand-free) (held ?block))
  (:action lift
    :parameters (?b)
    :precondition (and (clear ?b) (on-table ?b) (hand-free))
    :effect (and (held ?b) (not (on-table ?b)) (not (clear ?b)) (not (hand-free))))
  (:action lower
    :parameters (?b)
    :precondition (held ?b)
    :effect (and (on-table ?b) (clear ?b) (hand-free) (not (held ?b))))
  (:action stack
    :parameters (?b ?onto)
    :precondition (and (held ?b) (clear ?onto))
    :effect (and (on ?b ?onto) (clear ?b) (hand-free) (not (held ?b)) (not (clear ?onto))))
  (:action unstack
    :parameters (?b ?from)
    :precondition (and (on ?b ?from) (clear ?b) (hand-free))
    :effect (and (held ?b) (clear ?from) (not (on ?b ?from)) (not (clear ?b)) (not (hand-free)))))
