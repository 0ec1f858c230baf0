; expect 7:1 knot 4 decreases
G21 G90 G17
G00 X0. Y0. Z20.
G06.2 P3 K2 X0. Y0. Z20. R1. F100.
K2 X5. Y5.
K2 X10. Y0.
K1
K1
K1
