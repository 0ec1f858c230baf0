// SPDX-License-Identifier: Apache-2.0
#include "burin/model/kerf_predict.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "burin/base/text.h"
#include "burin/model/permissible.h"
#include "burin/model/student_t.h"

namespace burin::model {
namespace {

/// Thicknesses are typed decimals; this only absorbs their binary rounding.
constexpr double kSameThickness_mm = 1e-9;
/// Quantile of the two-sided 95 % interval.
constexpr double kQuantile = 0.975;

std::string mm(double value) {
  return format_shortest(value) + " mm";
}
/// Speeds for people: a tenth of a mm/min.
std::string speed(double value) {
  return format_fixed(value, 1);
}
std::string watts(double value) {
  return format_fixed(value, 3) + " W";
}
/// A setting for people that is still permissible when typed in: rounded into the range.
std::string inner_speed(double value, const PermissibleRange& range) {
  const double up = std::ceil(range.speed_min * 10) / 10, down = std::floor(range.speed_max * 10) / 10;
  return up <= down ? speed(std::clamp(value, up, down)) : format_shortest(value);
}

template <class Range, class Print>
std::string join(const Range& range, Print print) {
  std::string text;
  for (const auto& entry : range) text += (text.empty() ? "" : ", ") + print(entry);
  return text;
}
std::string join(const std::set<std::string>& words) {
  return join(words, [](const std::string& word) { return word; });
}

/// What a query is answered from: one model, or two neighbours and the weight of the second.
struct Basis {
  KerfModel model;
  PermissibleRegion region{{}};
  bool interpolated = false;
  std::string note;
};

Error unknown(const std::string& what, const std::string& name, const std::set<std::string>& known) {
  const std::string near = nearest_word(name, {known.begin(), known.end()});
  return {ErrorCode::range,
          "unknown " + what + " \"" + name + "\" (" + (near.empty() ? "" : "did you mean " + near + "? ") +
              "known: " + join(known) + ")",
          {}};
}

/// Models of the laser and material; errors name what is known.
Result<std::vector<KerfModel>> of_material(const std::vector<KerfModel>& models, const KerfQuery& query) {
  std::set<std::string> lasers, materials;
  std::vector<KerfModel> chosen;
  for (const KerfModel& m : models) {
    lasers.insert(m.laser);
    if (m.laser != query.laser) continue;
    materials.insert(m.material);
    if (m.material == query.material) chosen.push_back(m);
  }
  if (lasers.empty())
    return Error{ErrorCode::range, "the database holds no kerf model (burin kerf learn RUNS.csv)", {}};
  if (!lasers.count(query.laser)) return unknown("laser", query.laser, lasers);
  if (chosen.empty()) return unknown("material", query.material, materials);
  return chosen;
}

/// The version that was asked for, else the newest, of one thickness.
Result<KerfModel> at_thickness(const std::vector<KerfModel>& models, double thickness,
                               const KerfQuery& query) {
  const KerfModel* best = nullptr;
  std::set<int> versions;
  for (const KerfModel& m : models) {
    if (std::abs(m.thickness_mm - thickness) > kSameThickness_mm) continue;
    versions.insert(m.version);
    if (query.version ? m.version == *query.version : best == nullptr || m.version > best->version) best = &m;
  }
  if (best != nullptr) return *best;
  return Error{ErrorCode::range,
               "no version " + std::to_string(*query.version) + " of the model for " + query.laser + ", " +
                   query.material + ", " + mm(thickness) +
                   " (known: " + join(versions, [](int v) { return std::to_string(v); }) + ")",
               {}};
}

/// Coefficients linear in the thickness between two neighbours; permissible is what both permit.
Basis blend(const KerfModel& thin, const KerfModel& thick, double thickness) {
  const double t = (thickness - thin.thickness_mm) / (thick.thickness_mm - thin.thickness_mm);
  Basis basis;
  basis.region = PermissibleRegion({thin.permissible, thick.permissible});
  basis.interpolated = true;
  basis.note = "interpolated between " + mm(thin.thickness_mm) + " and " + mm(thick.thickness_mm) +
               ": not backed by experiments at " + mm(thickness);
  KerfModel& m = basis.model;
  m = thin;
  m.thickness_mm = thickness;
  m.version = std::max(thin.version, thick.version);
  m.lambda1 = thin.lambda1 + t * (thick.lambda1 - thin.lambda1);
  m.lambda2 = thin.lambda2 + t * (thick.lambda2 - thin.lambda2);
  m.r = std::min(thin.r, thick.r);
  m.source = thin.source == thick.source ? thin.source : thin.source + "; " + thick.source;
  m.runs_accepted = thin.runs_accepted + thick.runs_accepted;
  m.runs_rejected = thin.runs_rejected + thick.runs_rejected;
  m.statistics.reset();
  m.permissible = basis.region.table();
  return basis;
}

Result<Basis> find_basis(const std::vector<KerfModel>& all, const KerfQuery& query) {
  auto models = of_material(all, query);
  if (!models) return models.error();
  std::set<double> thicknesses;
  for (const KerfModel& m : *models) thicknesses.insert(m.thickness_mm);
  const auto above = thicknesses.lower_bound(query.thickness_mm - kSameThickness_mm);
  const bool exact = above != thicknesses.end() && *above <= query.thickness_mm + kSameThickness_mm;
  if (exact) {
    auto model = at_thickness(*models, *above, query);
    if (!model) return model.error();
    Basis basis;
    basis.model = std::move(model).value();
    basis.region = PermissibleRegion({basis.model.permissible});
    return basis;
  }
  const std::string known =
      "known: " + join(thicknesses, [](double t) { return format_shortest(t); }) + " mm";
  const bool between = above != thicknesses.begin() && above != thicknesses.end();
  if (!between || !query.interpolate) {
    return Error{
        ErrorCode::range,
        "no kerf model of " + query.laser + ", " + query.material + " for " + mm(query.thickness_mm) + " (" +
            known + (between ? "; --interpolate uses the two neighbours" : "; nothing is extrapolated") + ")",
        {}};
  }
  auto thin = at_thickness(*models, *std::prev(above), query);
  if (!thin) return thin.error();
  auto thick = at_thickness(*models, *above, query);
  if (!thick) return thick.error();
  return blend(*thin, *thick, query.thickness_mm);
}

Result<void> check_value(const char* what, const char* unit, double value) {
  if (std::isfinite(value) && value > 0) return {};
  return Error{ErrorCode::usage,
               std::string(what) + " " + format_shortest(value) + " is not possible (" + unit + ", above 0)",
               {}};
}

std::string describe(const KerfModel& model) {
  return model.laser + ", " + model.material + ", " + mm(model.thickness_mm);
}

std::string nearest_text(const Basis& basis, double power, double speed_mm_min) {
  const auto nearest = basis.region.nearest(power, speed_mm_min);
  if (!nearest) return "no setting is permissible";
  const auto range = basis.region.at(nearest->first);
  return "nearest permissible setting: " + watts(nearest->first) + " at " +
         (range ? inner_speed(nearest->second, *range) : speed(nearest->second)) + " mm/min";
}

std::string outside_text(const Basis& basis, const KerfQuery& query) {
  std::string text = watts(query.power_w) + " at " + speed(query.speed_mm_min) +
                     " mm/min is outside the permissible range of " + describe(basis.model);
  const auto range = basis.region.at(query.power_w);
  const auto& table = basis.model.permissible;
  text += " (";
  if (range) {
    text += inner_speed(range->speed_min, *range) + " to " + inner_speed(range->speed_max, *range) +
            " mm/min at " + watts(query.power_w) + "; ";
  } else if (!table.empty()) {
    text += watts(table.front().power_w) + " to " + watts(table.back().power_w) + "; ";
  }
  return text + nearest_text(basis, query.power_w, query.speed_mm_min) + ")";
}

/// 95 % interval of one new measurement (Neter, Wasserman & Kutner 1990, section 2.5).
std::optional<std::pair<double, double>> prediction_interval(const KerfModel& model, double heat,
                                                             double kerf) {
  if (!model.statistics || model.statistics->n < 3) return std::nullopt;
  const auto& s = *model.statistics;
  const double from_mean = heat - s.mean_q;
  const double sd = s.residual_sd * std::sqrt(1 + 1.0 / s.n + from_mean * from_mean / s.sum_sq_q);
  const double half = student_t_quantile(kQuantile, s.n - 2) * sd;
  return std::pair{kerf - half, kerf + half};
}

double kerf_at(const KerfModel& model, double power, double speed_mm_min) {
  return model.lambda1 * power / speed_mm_min + model.lambda2;
}

}  // namespace

Result<KerfPrediction> predict_kerf(const std::vector<KerfModel>& models, const KerfQuery& query) {
  if (auto fine = check_value("thickness", "mm", query.thickness_mm); !fine) return fine.error();
  if (auto fine = check_value("power", "W", query.power_w); !fine) return fine.error();
  if (auto fine = check_value("speed", "mm/min", query.speed_mm_min); !fine) return fine.error();
  auto found = find_basis(models, query);
  if (!found) return found.error();
  Basis basis = std::move(found).value();
  KerfPrediction prediction;
  prediction.permissible = basis.region.contains(query.power_w, query.speed_mm_min);
  prediction.interpolated = basis.interpolated;
  prediction.note = basis.note;
  if (!prediction.permissible) {
    const std::string outside = outside_text(basis, query);
    if (!query.force) return Error{ErrorCode::range, outside, {}};
    prediction.note += (prediction.note.empty() ? "" : "; ") + ("forced: " + outside);
  }
  prediction.kerf_mm = kerf_at(basis.model, query.power_w, query.speed_mm_min);
  if (!(prediction.kerf_mm > 0) || !std::isfinite(prediction.kerf_mm)) {
    return Error{ErrorCode::range,
                 "the model of " + describe(basis.model) + " gives no kerf above 0 for " +
                     watts(query.power_w) + " at " + speed(query.speed_mm_min) + " mm/min (" +
                     nearest_text(basis, query.power_w, query.speed_mm_min) + ")",
                 {}};
  }
  prediction.offset_mm = prediction.kerf_mm / 2;
  prediction.prediction_interval_mm =
      prediction_interval(basis.model, query.power_w / query.speed_mm_min, prediction.kerf_mm);
  prediction.model = std::move(basis.model);
  return prediction;
}

Result<std::vector<KerfSuggestion>> suggest_settings(const std::vector<KerfModel>& models,
                                                     const KerfQuery& query) {
  if (auto fine = check_value("thickness", "mm", query.thickness_mm); !fine) return fine.error();
  auto found = find_basis(models, query);
  if (!found) return found.error();
  const Basis basis = std::move(found).value();
  std::vector<PermissibleRange> ranges;
  if (query.power_w > 0) {
    const auto range = basis.region.at(query.power_w);
    if (!range) {
      const auto near = basis.region.nearest(query.power_w, 1);
      return Error{
          ErrorCode::range,
          watts(query.power_w) + " is outside the permissible range of " + describe(basis.model) + " (" +
              (near ? "nearest permissible power: " + watts(near->first) : "no setting is permissible") + ")",
          {}};
    }
    ranges.push_back(*range);
  } else {
    ranges = basis.region.table();
  }
  if (ranges.empty()) {
    return Error{ErrorCode::range,
                 "no setting is permissible for " + describe(basis.model) + " (another thickness)",
                 {}};
  }
  std::vector<KerfSuggestion> suggestions;
  for (const PermissibleRange& range : ranges) {
    suggestions.push_back({range.power_w, range.speed_min, range.speed_max,
                           kerf_at(basis.model, range.power_w, range.speed_max),
                           kerf_at(basis.model, range.power_w, range.speed_min)});
  }
  // Fastest first; at equal speed the lower power, which heats the sheet less.
  std::stable_sort(suggestions.begin(), suggestions.end(),
                   [](const KerfSuggestion& a, const KerfSuggestion& b) {
                     return a.speed_max != b.speed_max ? a.speed_max > b.speed_max : a.power_w < b.power_w;
                   });
  return suggestions;
}

}  // namespace burin::model
