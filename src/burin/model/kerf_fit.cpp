// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include "burin/base/text.h"
#include "burin/model/kerf_runs.h"

namespace burin::model {
namespace {

/// Two heat inputs (or powers) that differ relatively by less are one: settings have three or four digits.
constexpr double kSameSetting = 1e-9;

std::string group_name(const KerfRun& run) {
  return run.laser + ", " + run.material + ", " + format_shortest(run.thickness_mm) + " mm";
}

/// Fastest and slowest speed per power such that every speed tried between them was accepted at least once.
/// Where a failed speed lies between accepted ones, the side with more accepted runs counts, the faster one
/// if equal: a range must not contain a setting that is known to cut badly.
PermissibleRange permissible_at(double power, const std::vector<const KerfRun*>& runs) {
  std::map<double, std::pair<int, int>> speeds;  // speed -> accepted, rejected
  for (const KerfRun* run : runs) {
    auto& count = speeds[run->speed_mm_min];
    ++(rejection(*run) ? count.second : count.first);
  }
  PermissibleRange best{power, 0, 0}, current{power, 0, 0};
  int best_count = 0, count = 0;
  for (const auto& [speed, tried] : speeds) {
    if (tried.first == 0) {
      count = 0;
      continue;
    }
    if (count == 0) current.speed_min = speed;
    current.speed_max = speed;
    count += tried.first;
    if (count >= best_count) {
      best = current;
      best_count = count;
    }
  }
  return best;
}

std::vector<PermissibleRange> permissible_table(const std::vector<KerfRun>& runs) {
  std::map<double, std::vector<const KerfRun*>> by_power;
  for (const KerfRun& run : runs) by_power[run.power_w].push_back(&run);
  std::vector<PermissibleRange> table;
  for (const auto& [power, at_power] : by_power) {
    const PermissibleRange range = permissible_at(power, at_power);
    if (range.speed_max > 0) table.push_back(range);
  }
  return table;
}

/// Sums about the means, which loses no digits where raw sums of squares would.
struct Sums {
  double mean_q = 0, mean_k = 0, qq = 0, qk = 0, kk = 0;
};

Sums sums_about_means(const std::vector<const KerfRun*>& runs) {
  Sums s;
  const auto n = static_cast<double>(runs.size());
  for (const KerfRun* run : runs) {
    s.mean_q += run->heat() / n;
    s.mean_k += run->kerf_mm() / n;
  }
  for (const KerfRun* run : runs) {
    const double q = run->heat() - s.mean_q, k = run->kerf_mm() - s.mean_k;
    s.qq += q * q;
    s.qk += q * k;
    s.kk += k * k;
  }
  return s;
}

/// Ordinary least squares of kerf over Q (Neter, Wasserman & Kutner 1990, chapter 2, the paper's reference
/// 12).
void fit_line(const std::vector<const KerfRun*>& runs, KerfModel& model) {
  const Sums s = sums_about_means(runs);
  const auto n = static_cast<double>(runs.size());
  model.lambda1 = s.qk / s.qq;
  model.lambda2 = s.mean_k - model.lambda1 * s.mean_q;
  // All widths equal: no relation with the heat to speak of.
  model.r = s.kk > 0 ? std::clamp(s.qk / std::sqrt(s.qq * s.kk), -1.0, 1.0) : 0.0;
  double squares = 0;
  for (const KerfRun* run : runs) {
    const double miss = run->kerf_mm() - (s.mean_k + model.lambda1 * (run->heat() - s.mean_q));
    squares += miss * miss;
  }
  KerfStatistics& t = model.statistics.emplace();
  t.n = static_cast<int>(runs.size());
  t.residual_sd = std::sqrt(squares / (n - 2));
  t.mean_q = s.mean_q;
  t.sum_sq_q = s.qq;
  t.se_lambda1 = t.residual_sd / std::sqrt(s.qq);
  t.se_lambda2 = t.residual_sd * std::sqrt(1 / n + s.mean_q * s.mean_q / s.qq);
}

Result<KerfFit> fit_group(std::vector<KerfRun> runs, const std::string& file_name) {
  std::vector<const KerfRun*> accepted;
  for (const KerfRun& run : runs) {
    if (!rejection(run)) accepted.push_back(&run);
  }
  const Where where{.file = file_name, .line = runs.front().line};
  const std::string name = group_name(runs.front());
  if (accepted.size() < kMinAcceptedRuns) {
    return Error{ErrorCode::data,
                 name + ": " + std::to_string(accepted.size()) + " accepted of " +
                     std::to_string(runs.size()) + " runs are too few (at least " +
                     std::to_string(kMinAcceptedRuns) + " with 2 different P/V)",
                 where};
  }
  const auto [low, high] = std::minmax_element(
      accepted.begin(), accepted.end(), [](const auto* a, const auto* b) { return a->heat() < b->heat(); });
  if ((*high)->heat() - (*low)->heat() <= kSameSetting * (*high)->heat()) {
    return Error{
        ErrorCode::data,
        name + ": all accepted runs have the same P/V, which says nothing of its influence (2 different P/V)",
        where};
  }
  KerfFit fit;
  fit.model.laser = runs.front().laser;
  fit.model.material = runs.front().material;
  fit.model.thickness_mm = runs.front().thickness_mm;
  fit.model.version = 0;
  fit.model.source = std::filesystem::path(file_name).filename().string();
  fit.model.runs_accepted = static_cast<int>(accepted.size());
  fit.model.runs_rejected = static_cast<int>(runs.size() - accepted.size());
  fit_line(accepted, fit.model);
  fit.model.permissible = permissible_table(runs);
  fit.runs = std::move(runs);
  return fit;
}

}  // namespace

std::optional<std::string> rejection(const KerfRun& run) {
  if (run.kerf_top_mm <= 0 || run.kerf_bottom_mm <= 0)
    return "not cut through: a kerf of 0 (above 0 at top and bottom)";
  if (run.dross_area_mm2 > kMaxDrossArea_mm2) {
    return "dross area " + format_shortest(run.dross_area_mm2) + " mm2 (at most " +
           format_shortest(kMaxDrossArea_mm2) + ")";
  }
  if (run.straightness_mm > kMaxStraightness_mm) {
    return "straightness " + format_shortest(run.straightness_mm) + " mm (at most " +
           format_shortest(kMaxStraightness_mm) + ")";
  }
  return std::nullopt;
}

Result<std::vector<KerfFit>> fit_runs(const std::vector<KerfRun>& runs, const std::string& file_name) {
  std::map<std::tuple<std::string, std::string, double>, std::vector<KerfRun>> groups;
  for (const KerfRun& run : runs) groups[{run.laser, run.material, run.thickness_mm}].push_back(run);
  std::vector<KerfFit> fits;
  for (auto& [key, group] : groups) {
    auto fit = fit_group(std::move(group), file_name);
    if (!fit) return fit.error();
    fits.push_back(std::move(fit).value());
  }
  return fits;
}

}  // namespace burin::model
