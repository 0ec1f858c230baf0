// SPDX-License-Identifier: Apache-2.0
#include "layer_options.h"

#include <algorithm>
#include <string_view>

#include "burin/base/text.h"

namespace burin::cli {

void add_layers(CLI::App& app, std::vector<std::string>& lists) {
  app.add_option("--layers", lists, "NAME=cut|engrave|ignore,... by layer name or #rrggbb colour")
      ->type_name("LIST");
}

void add_drawing(CLI::App& app, laser::Side& side, io::Units& units, double& join_mm) {
  add_choice<laser::Side>(app, "--side", side,
                          {{"auto", laser::Side::automatic},
                           {"outside", laser::Side::outside},
                           {"inside", laser::Side::inside},
                           {"on", laser::Side::on}},
                          "where the beam runs: by nesting, one side for all, or on the line");
  add_choice<io::Units>(app, "--units", units, {{"mm", io::Units::mm}, {"inch", io::Units::inch}},
                        "unit of the drawing's numbers, whatever the file says");
  add_number(app, "--join", join_mm, kLength, "ends this close are joined (default 0.01)");
}

Result<std::map<std::string, laser::Treatment>> parse_layers(const std::vector<std::string>& lists) {
  std::map<std::string, laser::Treatment> layers;
  for (const std::string& list : lists) {
    for (std::size_t from = 0; from <= list.size();) {
      const std::size_t comma = std::min(list.find(',', from), list.size());
      const std::string item(trim(std::string_view(list).substr(from, comma - from)));
      from = comma + 1;
      if (item.empty()) continue;
      const std::size_t equals = item.rfind('=');
      const std::string how =
          equals == std::string::npos ? "" : to_lower(trim(std::string_view(item).substr(equals + 1)));
      const std::string name(trim(std::string_view(item).substr(0, equals)));
      if (name.empty() || (how != "cut" && how != "engrave" && how != "ignore"))
        return Error{ErrorCode::usage,
                     "--layers: " + item +
                         " is not understood (NAME=cut, NAME=engrave or NAME=ignore, separated by commas)",
                     {}};
      layers[name] = how == "cut"       ? laser::Treatment::cut
                     : how == "engrave" ? laser::Treatment::engrave
                                        : laser::Treatment::ignore;
    }
  }
  return layers;
}

}  // namespace burin::cli
