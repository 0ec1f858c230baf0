; expect 4:1 a feed move without a feed
G21 G90 G17
G00 X0. Y0. Z20.
G06.2 P3 K0 X0. Y0. Z20. R1.
K0 X5. Y5.
K0 X10. Y0.
K1
K1
K1
