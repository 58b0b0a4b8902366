; Derived predicates: what is above what, in any number of steps, and which crate is free.
(define (domain shelves)
  (:requirements :strips :typing :negative-preconditions :derived-predicates :equality)
  (:types crate spot)
  (:predicates (on ?a ?b - crate) (rests ?a - crate ?s - spot) (above ?a ?b - crate)
               (free ?a - crate) (empty ?s - spot) (fixed ?a - crate))
  (:derived (above ?a ?b - crate)
    (or (on ?a ?b) (exists (?c - crate) (and (on ?a ?c) (above ?c ?b)))))
  (:derived (free ?a - crate) (not (exists (?top - crate) (on ?top ?a))))
  (:derived (empty ?s - spot) (not (exists (?a - crate) (rests ?a ?s))))
  (:action pile
    :parameters (?a ?b - crate ?s - spot)
    :precondition (and (free ?a) (free ?b) (rests ?a ?s) (not (= ?a ?b)) (not (fixed ?a)))
    :effect (and (on ?a ?b) (not (rests ?a ?s))))
  (:action put-down
    :parameters (?a ?b - crate ?s - spot)
    :precondition (and (free ?a) (on ?a ?b) (empty ?s) (not (fixed ?a)))
    :effect (and (rests ?a ?s) (forall (?x - crate) (not (on ?a ?x))))))
