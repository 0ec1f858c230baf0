// SPDX-License-Identifier: Apache-2.0
#include "burin/removal/removal.h"

#include <new>
#include <string>

#include "burin/base/parallel.h"
#include "burin/base/text.h"
#include "burin/removal/field.h"
#include "burin/removal/stock_lines.h"

namespace burin::removal {
namespace {

using geom::component;

// Share of the longest side of the stock when no resolution is given.
constexpr double kDefaultShare = 1.0 / 200;
// Ends of what is cut are known to this share of the resolution.
constexpr double kEnds = 0.1;
// Cuts handled at once: about 50 MB.
constexpr std::size_t kPortion = 200'000;
// Tiles between two words of progress.
constexpr std::size_t kGroup = 256;

/// Cells no longer than `resolution`, as many as fill the box.
Grid grid_over(const geom::Box3& box, double resolution) {
  Grid grid;
  grid.origin = box.lo;
  for (std::size_t i = 0; i < 3; ++i) {
    const double length = component(box.hi, i) - component(box.lo, i);
    constexpr double kRounding = 1e-9;
    grid.count[i] = static_cast<std::uint32_t>(std::max(1.0, std::ceil(length / resolution - kRounding)));
    grid.step[i] = length / grid.count[i];
  }
  return grid;
}

double dexels_over(const geom::Box3& box, double resolution, bool three) {
  std::array<double, 3> n{};
  for (std::size_t i = 0; i < 3; ++i)
    n[i] = std::max(1.0, std::ceil((component(box.hi, i) - component(box.lo, i)) / resolution));
  return three ? n[0] * n[1] + n[1] * n[2] + n[2] * n[0] : n[0] * n[1];
}

Result<void> check_size(const geom::Box3& box, double resolution, bool three, std::size_t most) {
  const double dexels = dexels_over(box, resolution, three), limit = static_cast<double>(most);
  // Counts of one direction are 32 bits wide.
  constexpr double kSides = 1e9;
  const double sides = norm(box.hi - box.lo) / resolution;
  if (dexels <= limit && sides < kSides) return {};
  double would_do = resolution * std::max(1.0, std::sqrt(dexels / std::max(limit, 1.0)));
  would_do = std::max(would_do, norm(box.hi - box.lo) / kSides);
  constexpr int kDigits = 1000;  // rounded up to three decimals
  constexpr int kSteps = 400;    // of 2 %: cells that do not fit are a few
  for (int i = 0; i < kSteps && dexels_over(box, would_do, three) > limit; ++i) would_do *= 1.02;
  would_do = std::ceil(would_do * kDigits) / kDigits;
  return Error{ErrorCode::range,
               "material removal at " + format_shortest(resolution) + " mm needs " + format_fixed(dexels, 0) +
                   " dexels (up to " + std::to_string(most) + ": a resolution of " +
                   format_fixed(would_do, 3) + " mm would do)",
               {}};
}

Result<bool> three_directions(const verify::CheckedPath& path, Directions directions) {
  const bool upright = is_upright(path);
  if (directions == Directions::one && !upright)
    return Error{ErrorCode::unsupported,
                 "tool axes are tilted, dexels along Z alone do not do for them (three directions)",
                 {}};
  return directions == Directions::three || (directions == Directions::automatic && !upright);
}

Result<void> check(const RemovalOptions& options) {
  const auto wrong = [](const std::string& what) { return Error{ErrorCode::range, what, {}}; };
  if (!(options.resolution_mm >= 0) || !std::isfinite(options.resolution_mm))
    return wrong("the resolution of the removal must be positive (0: 1/200 of the stock)");
  if (!(options.contact_mm >= 0) || !std::isfinite(options.contact_mm))
    return wrong("the least depth of a contact must not be negative (mm)");
  return {};
}

/// Ends of cuts must be known better than the depth from which on something is a contact.
CutLimits limits_of(const RemovalOptions& options) {
  double ends = kEnds * options.resolution_mm;
  if (options.contact_mm > 0) ends = std::min(ends, 0.5 * options.contact_mm);
  return {ends, options.contact_mm};
}

double mean_volume(const std::vector<DexelField>& fields) {
  double sum = 0;
  for (const DexelField& f : fields) sum += f.volume();
  return sum / static_cast<double>(fields.size());
}

/// One contact a move and body out of those of tiles and directions. The depth is that of the direction in
/// which it is least: along a wall that is only grazed lines are long.
std::vector<StockContact> merge(std::vector<ContactPart> parts, const Grid& grid, std::size_t directions) {
  std::stable_sort(parts.begin(), parts.end(), [](const ContactPart& a, const ContactPart& b) {
    return a.move != b.move ? a.move < b.move : a.kind < b.kind;
  });
  std::vector<StockContact> out;
  for (std::size_t i = 0; i < parts.size();) {
    StockContact c;
    c.move = parts[i].move, c.body = parts[i].kind;
    std::array<const ContactPart*, 3> longest{};
    for (; i < parts.size() && parts[i].move == c.move && parts[i].kind == c.body; ++i) {
      c.volume_mm3 += parts[i].volume / static_cast<double>(directions);
      const ContactPart*& best = longest[parts[i].axis];
      if (!best || parts[i].depth > best->depth) best = &parts[i];
    }
    const ContactPart* least = nullptr;
    for (const ContactPart* p : longest)
      if (p && (!least || p->depth < least->depth)) least = p;
    c.depth_mm = static_cast<double>(least->depth);
    c.at = grid.origin + geom::Vec3{static_cast<double>(least->at[0]), static_cast<double>(least->at[1]),
                                    static_cast<double>(least->at[2])};
    out.push_back(c);
  }
  return out;
}

Result<std::unique_ptr<Field>> make_field(const Stock& stock, const verify::CheckedPath& path,
                                          const RemovalOptions& asked, ProgressSink* progress) {
  if (auto ok = check(asked); !ok) return ok.error();
  if (auto ok = validate(stock); !ok) return ok.error();
  if (auto ok = verify::validate(path); !ok) return ok.error();
  const auto three = three_directions(path, asked.directions);
  if (!three) return three.error();
  const geom::Box3 box = bounds(stock);
  auto field = std::make_unique<Field>();
  RemovalOptions& options = field->options;
  options = asked;
  if (options.resolution_mm == 0) {
    const geom::Vec3 size = box.hi - box.lo;
    options.resolution_mm = kDefaultShare * std::max({size.x, size.y, size.z});
  }
  options.threads = thread_count(asked.threads);
  if (auto ok = check_size(box, options.resolution_mm, *three, options.max_dexels); !ok) return ok.error();
  field->grid = grid_over(box, options.resolution_mm);
  for (const std::size_t axis : {0U, 1U, 2U})
    if (*three || axis == 2) field->fields.emplace_back(field->grid, axis);
  for (DexelField& f : field->fields)
    if (auto ok = fill(f, stock, options.threads); !ok) return ok.error();
  field->stock_mm3 = mean_volume(field->fields);
  auto contacts = cut_all(field->fields, path, limits_of(options), options.threads, progress);
  if (!contacts) return contacts.error();
  field->removed_mm3 = std::max(0.0, field->stock_mm3 - mean_volume(field->fields));
  field->contacts = merge(std::move(*contacts), field->grid, field->fields.size());
  if (options.keep_times) field->stock = stock, field->path = path;
  return field;
}

}  // namespace

Result<std::vector<ContactPart>> cut_all(std::vector<DexelField>& fields, const verify::CheckedPath& path,
                                         const CutLimits& limits, unsigned threads, ProgressSink* progress,
                                         NodeTimes times) {
  std::vector<ContactPart> contacts;
  std::size_t tiles = 0;
  for (const DexelField& f : fields) tiles += f.tile_count();
  CutSource source(path, fields.front().grid(), limits.tolerance);
  double before = 0;
  for (std::vector<Cut> cuts = source.next(kPortion); !cuts.empty(); cuts = source.next(kPortion)) {
    const CutTree tree(cuts);
    for (std::size_t first = 0; first < tiles; first += kGroup) {
      const std::size_t count = std::min(kGroup, tiles - first);
      std::vector<std::vector<ContactPart>> found(count);
      parallel_for(count, threads, [&](std::size_t task, std::size_t) {
        std::size_t t = first + task, f = 0;
        while (t >= fields[f].tile_count()) t -= fields[f++].tile_count();
        const bool marks = times.cut_at && fields[f].axis() == 2;
        TileCutter(fields[f], t, limits, marks ? times : NodeTimes{}).run(cuts, tree, found[task]);
      });
      for (const auto& part : found) contacts.insert(contacts.end(), part.begin(), part.end());
      const double share = static_cast<double>(first + count) / static_cast<double>(tiles);
      if (progress && !progress->progress("material removal", before + (source.done() - before) * share))
        return Error{ErrorCode::usage, "stopped", {}};
    }
    before = source.done();
  }
  for (DexelField& f : fields)
    parallel_for(f.tile_count(), threads, [&](std::size_t t, std::size_t) { f.tile(t).shrink(); });
  return contacts;
}

Removal::Removal(std::unique_ptr<Field> field) : field_(std::move(field)) {}
Removal::Removal(Removal&&) noexcept = default;
Removal& Removal::operator=(Removal&&) noexcept = default;
Removal::~Removal() = default;
double Removal::stock_mm3() const {
  return field_->stock_mm3;
}
double Removal::removed_mm3() const {
  return field_->removed_mm3;
}
double Removal::resolution_mm() const {
  return field_->options.resolution_mm;
}
const std::vector<StockContact>& Removal::contacts() const {
  return field_->contacts;
}
geom::Mesh Removal::mesh() const {
  try {
    return surface(field_->grid, field_->fields);
  } catch (const std::bad_alloc&) {
    return {};
  }
}
StockClock Removal::clock(std::size_t max_nodes) const {
  if (!field_->stock || !field_->path) return {};
  try {
    return make_clock(*field_->stock, *field_->path, limits_of(field_->options), field_->options.threads,
                      max_nodes);
  } catch (const std::bad_alloc&) {
    return {};
  }
}

Result<Removal> remove_material(const Stock& stock, const verify::CheckedPath& path,
                                const RemovalOptions& options, ProgressSink* progress) {
  try {
    auto field = make_field(stock, path, options, progress);
    if (!field) return field.error();
    return Removal(std::move(*field));
  } catch (const std::bad_alloc&) {
    return Error{
        ErrorCode::range, "material removal needs more memory than there is (a coarser resolution)", {}};
  }
}

}  // namespace burin::removal
