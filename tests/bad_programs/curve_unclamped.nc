; expect 6:1 knot 3 differs: the first 3 knots must be equal
G21 G90 G17
G00 X0. Y0. Z20.
G06.2 P3 K0 X0. Y0. Z20. R1. F100.
K0 X5. Y5.
K0.5 X10. Y0.
K1
K1
K1
