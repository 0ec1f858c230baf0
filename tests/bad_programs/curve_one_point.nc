; expect 4:1 all control points of the curve are one point
G21 G90 G17
G00 X0. Y0. Z20.
G06.2 P3 K0 X0. Y0. Z20. R1. F100.
K0 X0. Y0.
K0 X0. Y0.
K1
K1
K1
