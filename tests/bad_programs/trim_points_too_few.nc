; expect 11:1 the trim loop in line 9 lacks 1 point
G21 G90 G17
G00 X0. Y0. Z20.
G06.23 U2 V2 P2 Q2 D5. L0. F500. S0.01
X0. Y0. Z0. W1.
X10.
X0. Y10.
X10.
(BURIN TRIM LOOP 3)
(BURIN TRIM 0,0 1,0)
G00 Z50.
