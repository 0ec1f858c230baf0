// SPDX-License-Identifier: Apache-2.0
// The frame of the command line: subcommands, common options, checked values, and the Session in which one
// subcommand runs. A subcommand is one file with a function `void add_NAME(Cli& cli)` that main.cpp calls.
//
//   void add_laser(Cli& cli) {
//     auto args = std::make_shared<LaserArgs>();
//     CLI::App& app = cli.add_command("laser", "what it does", "  burin laser part.dxf --kerf 0.4\n",
//                                     [args](Session& session) { return run_laser(*args, session); });
//     add_number(app, "--kerf", args->kerf_mm, kPositiveLength, "width of the cut");
//     cli.add_output(app, "NC program (default: the drawing's name with .ngc)");
//     cli.add_json(app);
//   }
//
// The work reads through Session::read_input, collects warnings in session.diagnostics, fills session.report,
// and hands every output to Session::put. Nothing is written before the work has succeeded.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burin/base/result.h"
#include "session.h"

namespace burin::cli {

inline constexpr int kDone = 0;
inline constexpr int kFailed = 1;  ///< the input cannot be processed
inline constexpr int kWrongUsage = 2;
inline constexpr int kLeftOut = 3;  ///< done, but something was left out

using Work = std::function<Result<void>(Session&)>;

class Cli {
 public:
  Cli();

  /// A subcommand; `examples` go at the end of its help, one command a line, indented by two.
  CLI::App& add_command(const std::string& name, const std::string& description, const std::string& examples,
                        Work work);
  /// A command that only groups others ("burin kerf predict").
  CLI::App& add_group(const std::string& name, const std::string& description, const std::string& examples);
  CLI::App& add_command(CLI::App& group, const std::string& name, const std::string& description,
                        const std::string& examples, Work work);

  /// Common options; what they read stands in Session::common.
  void add_output(CLI::App& app, const std::string& what);  ///< -o FILE
  void add_cl(CLI::App& app);
  void add_json(CLI::App& app);
  void add_html(CLI::App& app);
  void add_svg(CLI::App& app);
  void add_tolerance(CLI::App& app);
  void add_dialect(CLI::App& app);
  void add_threads(CLI::App& app);
  /// The command may run on several processes (mpirun); others run on the first alone.
  void allow_ranks(CLI::App& app);

  /// Parses, runs the subcommand, writes its outputs, prints messages; returns the exit code.
  int run(int argc, const char* const* argv);

 private:
  struct Command {
    std::string operation;
    Work work;
    bool ranks = false;
  };
  CLI::App& add_to(CLI::App& parent, const std::string& name, const std::string& description,
                   const std::string& examples);
  int execute(const Command& command, const std::string& command_line, const Launch& launch);

  std::unique_ptr<CLI::App> root_;
  Common common_;
  bool version_ = false;
  std::map<const CLI::App*, Command> commands_;
};

/// Which numbers an option takes. `unit` is the placeholder of the help ("MM"), `accepted` ends the error
/// message.
struct NumberRule {
  const char* unit;
  const char* accepted;
  double min = -std::numeric_limits<double>::max();
  double max = std::numeric_limits<double>::max();
  bool min_open = false;  ///< min itself is refused
};
/// Lengths beyond a kilometre, powers beyond a megawatt and the like are slips of the keyboard.
inline constexpr NumberRule kPositiveLength{"MM", "a length in mm above 0", 0, 1e6, true};
inline constexpr NumberRule kLength{"MM", "a length in mm, 0 or more", 0, 1e6, false};
inline constexpr NumberRule kSignedLength{"MM", "a length in mm, negative too", -1e6, 1e6, false};
inline constexpr NumberRule kPower{"W", "a power in W above 0", 0, 1e6, true};
inline constexpr NumberRule kSpeed{"MM/MIN", "a speed in mm/min above 0", 0, 1e7, true};
inline constexpr NumberRule kAngle{"DEG", "an angle in degrees, 0 to 180", 0, 180, false};
inline constexpr NumberRule kFactor{"FACTOR", "a factor above 0, at most 1", 0, 1, true};

/// A number with a decimal point, inside its rule; anything else is wrong usage that says what is accepted.
CLI::Option* add_number(CLI::App& app, const std::string& name, std::optional<double>& target,
                        const NumberRule& rule, const std::string& description);
CLI::Option* add_number(CLI::App& app, const std::string& name, double& target, const NumberRule& rule,
                        const std::string& description);
CLI::Option* add_integer(CLI::App& app, const std::string& name, int& target, int min, int max,
                         const std::string& description);
CLI::Option* add_integer(CLI::App& app, const std::string& name, std::optional<int>& target, int min, int max,
                         const std::string& description);
/// A text that must not be empty (a name, a file).
CLI::Option* add_text(CLI::App& app, const std::string& name, std::string& target,
                      const std::string& placeholder, const std::string& description);

/// The index of `text` among `words`; throws the usage error that lists them and names the nearest.
std::size_t choose(const std::string& option, const std::string& text, const std::vector<std::string>& words);

/// One of a few words, each standing for a value.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& target,
                        std::vector<std::pair<std::string, T>> choices, const std::string& description) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  std::string placeholder;
  for (const std::string& word : words) placeholder += (placeholder.empty() ? "" : "|") + word;
  return app
      .add_option_function<std::string>(
          name,
          [name, words, choices, &target](const std::string& text) {
            target = choices[choose(name, text, words)].second;
          },
          description)
      ->type_name(placeholder);
}

}  // namespace burin::cli
