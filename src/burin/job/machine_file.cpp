// SPDX-License-Identifier: Apache-2.0
#include "burin/job/machine_file.h"

#include <filesystem>

#include "burin/model/machine.h"

namespace burin::job {

Result<std::optional<kinematics::Kinematics>> load_machine(const std::string& name, const std::string& folder,
                                                           const FileSource& read) {
  namespace fs = std::filesystem;
  if (name == "none") return std::optional<kinematics::Kinematics>();
  const bool from_file = fs::path(name).extension() == ".toml";
  const std::string path = (fs::path(folder) / name).string();
  const auto machine = [&]() -> Result<model::Machine> {
    if (!from_file) return model::find_machine(name);
    auto text = read(path);
    if (!text) return text.error();
    return model::parse_machine(*text, path);
  }();
  if (!machine) return machine.error();
  auto made = kinematics::Kinematics::make(*machine);
  if (made) return std::optional<kinematics::Kinematics>(std::move(*made));
  Error error = made.error();
  if (from_file && error.where.file.empty()) error.where.file = path;
  return error;
}

}  // namespace burin::job
