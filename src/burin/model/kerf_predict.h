// SPDX-License-Identifier: Apache-2.0
// Questions to a list of kerf models: pure functions behind KerfDatabase::predict and suggest. Internal to
// model.
#pragma once

#include <vector>

#include "burin/base/result.h"
#include "burin/model/kerf.h"

namespace burin::model {

Result<KerfPrediction> predict_kerf(const std::vector<KerfModel>& models, const KerfQuery& query);
Result<std::vector<KerfSuggestion>> suggest_settings(const std::vector<KerfModel>& models,
                                                     const KerfQuery& query);

}  // namespace burin::model
