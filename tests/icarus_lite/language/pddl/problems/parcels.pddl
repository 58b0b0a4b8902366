; Parcels by van and plane: a hierarchy of types, action costs.
(define (domain parcels)
  (:requirements :strips :typing :action-costs)
  (:types vehicle parcel - thing van plane - vehicle place town - object depot airfield - place)
  (:predicates (at ?t - thing ?p - place) (in ?p - parcel ?v - vehicle) (of ?p - place ?t - town))
  (:functions (distance ?from ?to - place) (total-cost) - number)
  (:action load
    :parameters (?p - parcel ?v - vehicle ?where - place)
    :precondition (and (at ?v ?where) (at ?p ?where))
    :effect (and (in ?p ?v) (not (at ?p ?where)) (increase (total-cost) 1)))
  (:action unload
    :parameters (?p - parcel ?v - vehicle ?where - place)
    :precondition (and (at ?v ?where) (in ?p ?v))
    :effect (and (at ?p ?where) (not (in ?p ?v)) (increase (total-cost) 1)))
  (:action drive
    :parameters (?v - van ?from ?to - place ?t - town)
    :precondition (and (at ?v ?from) (of ?from ?t) (of ?to ?t))
    :effect (and (at ?v ?to) (not (at ?v ?from)) (increase (total-cost) (distance ?from ?to))))
  (:action fly
    :parameters (?v - plane ?from ?to - airfield)
    :precondition (at ?v ?from)
    :effect (and (at ?v ?to) (not (at ?v ?from)) (increase (total-cost) (distance ?from ?to)))))
