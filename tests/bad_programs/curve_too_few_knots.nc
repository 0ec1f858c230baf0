; expect 9:1 G0 inside the curve of line 4
G21 G90 G17
G00 X0. Y0. Z20.
G06.2 P3 K0 X0. Y0. Z20. R1. F100.
K0 X5. Y5.
K0 X10. Y0.
K1
K1
G00 Z30.
