; Sussman's anomaly.
(define (problem sussman)
  (:domain blocks)
  (:objects a b c)
  (:init (on c a) (on-table a) (on-table b) (clear b) (clear c) (hand-free))
  (:goal (and (on a b) (on b c))))
