; expect 4:2 BURIN TRIM outside of a surface
G21 G90 G17
G00 X0. Y0. Z20.
(BURIN TRIM LOOP 3)
