// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "burin/base/text.h"
#include "terminal.h"

namespace burin::cli {
namespace {

/// Wrong usage found while the arguments are read.
struct UsageError {
  std::string message;
  const CLI::App* app = nullptr;  ///< whose --help is recommended
};

std::string in_quotes(std::string_view text) {
  return "\"" + std::string(text) + "\"";
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& known,
                       const std::string& otherwise) {
  std::string near;
  for (const std::string& candidate : known) {
    // The start of a longer name is what people type who expect abbreviations; "--" starts them all.
    if (word.size() > 3 && candidate.starts_with(word)) near = candidate;
  }
  if (near.empty()) near = nearest_word(word, known);
  return near.empty() ? otherwise : "did you mean " + near + "?";
}

std::string full_name(const CLI::App* app) {
  std::string name = app->get_name();
  for (const CLI::App* up = app->get_parent(); up != nullptr; up = up->get_parent())
    name = up->get_name() + " " + name;
  return name;
}

/// The innermost command that the arguments name.
const CLI::App* chosen_command(const CLI::App& root) {
  const CLI::App* app = &root;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return app;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// Looks at the arguments before CLI11 does, to say precisely what is wrong: unknown commands and options
/// (CLI11 would complain of a missing file first, or take the value of a mistyped option for the file),
/// options given twice or without their value.
class Check {
 public:
  Check(const CLI::App& root, const std::vector<std::string>& arguments)
      : app_(&root), arguments_(arguments) {}

  void run() {
    for (at_ = 0; at_ < arguments_.size(); ++at_) {
      const std::string& argument = arguments_[at_];
      if (argument == "--") return;
      if (argument.size() > 1 && argument[0] == '-') {
        check_option(argument);
        if (help_) return;
      } else if (!subcommand_names(*app_).empty()) {
        enter(argument);
      }
    }
    if (!subcommand_names(*app_).empty() && !version_) {
      throw UsageError{"a command is missing (" + list(subcommand_names(*app_)) + ")", app_};
    }
  }

 private:
  void enter(const std::string& name) {
    const auto found =
        app_->get_subcommands([&name](const CLI::App* sub) { return sub->get_name() == name; });
    if (found.empty()) {
      const auto names = subcommand_names(*app_);
      throw UsageError{"unknown command " + in_quotes(name) + " (" +
                           suggestion(name, names, "one of: " + list(names)) + ")",
                       app_};
    }
    app_ = found.front();
    given_.clear();
  }

  void check_option(const std::string& argument) {
    const bool is_long = argument.starts_with("--");
    const std::size_t equals = is_long ? argument.find('=') : std::string::npos;
    const std::string name = is_long ? argument.substr(0, equals) : argument.substr(0, 2);
    const CLI::Option* option = app_->get_option_no_throw(name);
    if (option == nullptr) {
      throw UsageError{"unknown option " + name + " (" +
                           suggestion(name, option_names(*app_), "see " + full_name(app_) + " --help") + ")",
                       app_};
    }
    if (option == app_->get_help_ptr()) help_ = true;
    if (app_->get_parent() == nullptr && name == "--version") version_ = true;
    const bool takes_value = option->get_items_expected_max() > 0;
    if (!takes_value) {
      if (equals != std::string::npos) throw UsageError{name + " takes no value", app_};
      return;
    }
    const bool once = option->get_items_expected_max() == 1;
    if (once && !given_.insert(option).second)
      throw UsageError{name + " is given twice (once is enough)", app_};
    const bool attached = is_long ? equals != std::string::npos : argument.size() > 2;
    const bool empty = attached && is_long && equals + 1 == argument.size();
    if (empty || (!attached && at_ + 1 >= arguments_.size())) {
      throw UsageError{name + " wants a value (" + name + " " + option->get_type_name() + ")", app_};
    }
    if (!attached) ++at_;
  }

  const CLI::App* app_;
  const std::vector<std::string>& arguments_;
  std::size_t at_ = 0;
  std::set<const CLI::Option*> given_;
  bool help_ = false, version_ = false;
};

std::string reworded(const CLI::ParseError& error) {
  if (error.get_name() == "RequiredError") {
    std::string what = error.what();
    constexpr std::string_view kTail = " is required";
    if (what.ends_with(kTail)) return what.substr(0, what.size() - kTail.size()) + " is missing";
  }
  return error.what();
}

int print_and_check(const std::string& text) {
  const bool fine = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
  if (fine) return kDone;
  print_error("burin: standard output cannot be written");
  return kFailed;
}

/// As one would type it again; only what needs quotes gets them.
std::string shell_words(int argc, const char* const* argv) {
  std::string line = "burin";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n\"'\\$`*?[](){}<>|&;#~!") == std::string::npos;
    line += ' ';
    if (plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

double checked_number(const std::string& option, const std::string& text, const NumberRule& rule) {
  const auto value = parse_double(text);
  if (!value)
    throw CLI::ValidationError(option, in_quotes(text) + " is not a number (" + rule.accepted + ")");
  if (*value < rule.min || *value > rule.max || (rule.min_open && *value == rule.min)) {
    throw CLI::ValidationError(option, text + " is not possible (" + rule.accepted + ")");
  }
  return *value;
}

int checked_integer(const std::string& option, const std::string& text, int min, int max) {
  const std::string accepted =
      "(a whole number from " + std::to_string(min) + " to " + std::to_string(max) + ")";
  const auto value = parse_integer(text);
  if (!value) throw CLI::ValidationError(option, in_quotes(text) + " is not a whole number " + accepted);
  if (*value < min || *value > max) throw CLI::ValidationError(option, text + " is not possible " + accepted);
  return static_cast<int>(*value);
}

/// An option that hands its text to `take`, which throws CLI::ValidationError.
CLI::Option* add_checked(CLI::App& app, const std::string& name, const std::string& placeholder,
                         const std::string& description,
                         const std::function<void(const std::string&)>& take) {
  return app.add_option_function<std::string>(name, take, description)->type_name(placeholder);
}

}  // namespace

std::size_t choose(const std::string& option, const std::string& text,
                   const std::vector<std::string>& words) {
  const auto found = std::find(words.begin(), words.end(), text);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  const std::string near = nearest_word(text, words);
  throw CLI::ValidationError(option, in_quotes(text) + " is not known (one of: " + list(words) +
                                         (near.empty() ? "" : "; did you mean " + near + "?") + ")");
}

CLI::Option* add_number(CLI::App& app, const std::string& name, std::optional<double>& target,
                        const NumberRule& rule, const std::string& description) {
  return add_checked(app, name, rule.unit, description, [&target, name, rule](const std::string& text) {
    target = checked_number(name, text, rule);
  });
}

CLI::Option* add_number(CLI::App& app, const std::string& name, double& target, const NumberRule& rule,
                        const std::string& description) {
  return add_checked(app, name, rule.unit, description, [&target, name, rule](const std::string& text) {
    target = checked_number(name, text, rule);
  });
}

CLI::Option* add_integer(CLI::App& app, const std::string& name, int& target, int min, int max,
                         const std::string& description) {
  return add_checked(app, name, "N", description, [&target, name, min, max](const std::string& text) {
    target = checked_integer(name, text, min, max);
  });
}

CLI::Option* add_integer(CLI::App& app, const std::string& name, std::optional<int>& target, int min, int max,
                         const std::string& description) {
  return add_checked(app, name, "N", description, [&target, name, min, max](const std::string& text) {
    target = checked_integer(name, text, min, max);
  });
}

CLI::Option* add_text(CLI::App& app, const std::string& name, std::string& target,
                      const std::string& placeholder, const std::string& description) {
  return add_checked(app, name, placeholder, description,
                     [&target, name, placeholder](const std::string& text) {
                       if (trim(text).empty())
                         throw CLI::ValidationError(name, "is empty (" + placeholder + ")");
                       target = text;
                     });
}

Cli::Cli()
    : root_(std::make_unique<CLI::App>(
          "Turns designs and process knowledge into interference-free, machine-ready motion.", "burin")) {
  root_->set_help_flag("-h,--help", "print this help and exit");
  root_->add_flag("--version", version_, "print the version and exit");
  root_->get_formatter()->column_width(34);
  root_->footer(
      "Exit codes: 0 done, 1 the input cannot be processed, 2 wrong usage, 3 done but something was left "
      "out.\n"
      "\"burin COMMAND --help\" shows the options and examples of a command.");
}

CLI::App& Cli::add_to(CLI::App& parent, const std::string& name, const std::string& description,
                      const std::string& examples) {
  CLI::App* app = parent.add_subcommand(name, description);
  app->footer("Examples:\n" + examples);
  return *app;
}

CLI::App& Cli::add_command(const std::string& name, const std::string& description,
                           const std::string& examples, Work work) {
  return add_command(*root_, name, description, examples, std::move(work));
}

CLI::App& Cli::add_group(const std::string& name, const std::string& description,
                         const std::string& examples) {
  return add_to(*root_, name, description, examples);
}

CLI::App& Cli::add_command(CLI::App& group, const std::string& name, const std::string& description,
                           const std::string& examples, Work work) {
  CLI::App& app = add_to(group, name, description, examples);
  app.add_flag("--quiet", common_.quiet, "no progress and no notes on standard error");
  const std::string operation = &group == root_.get() ? name : group.get_name() + " " + name;
  commands_[&app] = {operation, std::move(work), false};
  return app;
}

void Cli::add_output(CLI::App& app, const std::string& what) {
  add_text(app, "-o,--output", common_.output, "FILE", what + "; - is standard output");
}
void Cli::add_cl(CLI::App& app) {
  add_text(app, "--cl", common_.cl, "FILE", "tool path as APT CL text");
}
void Cli::add_json(CLI::App& app) {
  add_text(app, "--json", common_.json, "FILE", "report with all figures and warnings as JSON");
}
void Cli::add_html(CLI::App& app) {
  add_text(app, "--html", common_.html, "FILE", "report with pictures, one self-contained page");
}
void Cli::add_svg(CLI::App& app) {
  add_text(app, "--svg", common_.svg, "FILE", "picture of the result as SVG");
}
void Cli::add_tolerance(CLI::App& app) {
  static constexpr NumberRule kRule{"MM", "a length in mm above 0, at most 1000", 0, 1000, true};
  add_number(app, "--tolerance", common_.tolerance_mm, kRule, "largest deviation of the path (default 0.01)");
}
void Cli::add_dialect(CLI::App& app) {
  add_choice<std::string>(app, "--dialect", common_.dialect,
                          {{"linuxcnc", "linuxcnc"}, {"fanuc", "fanuc"}, {"grbl", "grbl"}},
                          "control that runs the program (default linuxcnc)");
}
void Cli::add_threads(CLI::App& app) {
  add_integer(app, "--threads", common_.threads, 1, 1024,
              "threads to work with (default: all of the machine)");
}

void Cli::allow_ranks(CLI::App& app) {
  commands_[&app].ranks = true;
}

int Cli::run(int argc, const char* const* argv) {
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  const Launch launch = find_launch();
  const bool first = launch.rank == 0;
  try {
    root_->require_subcommand(0, 1);
    Check(*root_, arguments).run();
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    root_->parse(reversed);
  } catch (const UsageError& error) {
    if (!first) return kDone;  // the first process says it once
    if (arguments.empty()) std::fputs(root_->help().c_str(), stderr);
    print_error(full_name(error.app) + ": " + error.message);
    return kWrongUsage;
  } catch (const CLI::CallForHelp&) {
    if (!first) return kDone;
    return print_and_check(root_->help());
  } catch (const CLI::ParseError& error) {
    if (!first) return kDone;
    print_error(full_name(chosen_command(*root_)) + ": " + reworded(error));
    return kWrongUsage;
  }
  if (version_ && !first) return kDone;
  if (version_) return print_and_check(std::string("burin ") + BURIN_VERSION + "\n");

  const CLI::App* app = chosen_command(*root_);
  const auto command = commands_.find(app);
  if (command == commands_.end()) {
    print_error(full_name(app) + ": a command is missing");
    return kWrongUsage;
  }
  return execute(command->second, shell_words(argc, argv), launch);
}

int Cli::execute(const Command& command, const std::string& command_line, const Launch& launch) {
  const std::unique_ptr<Cluster> cluster = command.ranks ? join_cluster(launch) : nullptr;
  // Other processes of a command that has no work for them, or of a burin that cannot reach them, are done.
  if (cluster == nullptr && launch.rank > 0) return kDone;
  Session session(command.operation, common_, command_line, cluster.get());
  if (cluster == nullptr && launch.several && command.ranks && !built_with_mpi())
    session.diagnostics.info("one_process",
                             "this burin was built without MPI: one process does all the work");
  // Clashes of output names are found before any work.
  auto run = [&]() -> Result<void> {
    for (const std::string* path :
         {&common_.output, &common_.cl, &common_.json, &common_.svg, &common_.html}) {
      if (path->empty()) continue;
      if (auto reserved = session.reserve_output(*path); !reserved) return reserved.error();
    }
    if (auto worked = command.work(session); !worked) return worked.error();
    return session.finish();
  };
  const auto done = run();
  session.end_progress();              // also after an error, before messages
  if (!session.first()) return kDone;  // the first process says what came of it
  print_warnings(session.diagnostics, common_.quiet);
  if (!done) {
    const bool placed = !done.error().where.to_string().empty();
    print_error((placed ? "" : "burin " + command.operation + ": ") + done.error().to_string());
    return done.error().code == ErrorCode::usage ? kWrongUsage : kFailed;
  }
  for (const std::string& why : session.short_of()) print_error("burin " + command.operation + ": " + why);
  if (!session.short_of().empty()) return kFailed;
  return session.diagnostics.anything_left_out() ? kLeftOut : kDone;
}

}  // namespace burin::cli
