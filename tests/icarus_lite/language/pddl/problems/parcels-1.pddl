(define (problem one-parcel)
  (:domain parcels)
  (:objects red - van jet - plane letter - parcel north south - town
            d1 d2 - depot a1 a2 - airfield)
  (:init (of d1 north) (of a1 north) (of d2 south) (of a2 south)
         (at red d1) (at jet a2) (at letter d1)
         (= (distance d1 a1) 4) (= (distance a1 a2) 90) (= (total-cost) 0))
  (:goal (at letter a2))
  (:metric minimize (total-cost)))
