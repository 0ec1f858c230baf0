// SPDX-License-Identifier: Apache-2.0
// Student's t distribution, as far as prediction intervals need it.
#pragma once

namespace burin::model {

/// P(T <= t) for `degrees` >= 1 degrees of freedom. Absolute error below 1e-12.
double student_t_cdf(double t, int degrees);

/// The t with P(T <= t) = p, for 0 < p < 1. Relative error below 1e-9 for p between 0.0005 and 0.9995.
double student_t_quantile(double p, int degrees);

}  // namespace burin::model
