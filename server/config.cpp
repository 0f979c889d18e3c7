#include "server/config.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/api.hpp"
#include "api/wire/field_names.hpp"
#include "server/access.hpp"
#include "server/http/networks.hpp"

namespace tubecut::server {
namespace {

/// --some-name also as TUBECUT_SOME_NAME.
template <class T>
CLI::Option* option(CLI::App& app, const std::string& name, T& value, const std::string& help) {
  std::string variable = "TUBECUT_" + name;
  for (char& c : variable) {
    c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  auto* const added = app.add_option("--" + name, value, help)->envname(variable);
  if constexpr (std::is_same_v<T, std::vector<std::string>>) return added;  // no default to show
  return added->capture_default_str();
}

/// A number from `low` to `high`. CLI::Range lets NaN through.
auto number(double low, double high) {
  return [low, high](const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    return value >= low && value <= high
               ? std::string{}
               : fmt::format("{} is no number from {} to {}", text, low, high);
  };
}

void add_network(CLI::App& app, Config& c) {
  const CLI::Range port(0, 65535);
  option(app, "host", c.host, "address to listen on; 0.0.0.0 in a container");
  option(app, "port", c.port, "port of the service; if 0, a free one")->check(port);
  option(app, "admin-host", c.admin_host, "address of the admin port");
  option(app, "admin-port", c.admin_port, "port of /livez, /readyz, /metrics; if 0, a free one")
      ->check(port);
  option(app, "keys", c.keys, "file of API keys, one \"identity sha256 [rate]\" a line");
  std::ignore = app.add_flag("--open", c.open, "serve beyond this machine without keys")
                    ->envname("TUBECUT_OPEN");
  option(app, "cors-origin", c.cors_origins, "origins whose pages may call, such as https://a.b")
      ->delimiter(',');
  option(app, "trusted-proxy", c.trusted_proxies,
         "addresses or networks whose X-Forwarded-For is trusted")
      ->delimiter(',');
  option(app, "hosts", c.hosts, "names besides its own under which Host may call it; * for any")
      ->delimiter(',');
  option(app, "machines", c.machines, "folder whose *.json files join GET /v1/machines");
  option(app, "posts", c.posts, "folder whose *.json files join GET /v1/posts");
  option(app, "replica", c.replica, "name sent as Tubecut-Replica; if empty, the host's name");
}

void add_limits(CLI::App& app, Config& c) {
  const auto seconds = number(0.01, 3600.0);
  option(app, "connections", c.connections,
         "connections open at a time; when all are open, idle ones end")
      ->check(CLI::Range(1, 100000));
  option(app, "connections-per-client", c.connections_per_client,
         "of those, one address's or key's at most; if 0, half")
      ->check(CLI::Range(0, 100000));
  option(app, "slots", c.slots, "jobs computed at a time; if 0, by cgroup, affinity, machine")
      ->check(CLI::Range(0, 1024));
  option(app, "queue", c.queue, "jobs that wait for a slot; more are 429")
      ->check(CLI::Range(std::size_t{0}, std::size_t{100000}));
  option(app, "memory-bytes", c.memory_bytes,
         "for bodies, jobs and answers; if 0, 60 % of the available memory")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1} << 40));
  option(app, "budget-s", c.budget_s,
         "CPU of any job; Tubecut-Budget-Ms lowers it; if 0, by endpoint, see GET /v1/limits")
      ->check([seconds](const std::string& text) {
        return text == "0" ? std::string{} : seconds(text);
      });
  option(app, "max-body-bytes", c.max_body_bytes, "largest body; lowers the endpoints' own limits")
      ->check(CLI::Range(std::size_t{1}, std::size_t{8u << 20}));
  option(app, "max-target-bytes", c.max_target_bytes, "longest path with query")
      ->check(CLI::Range(std::size_t{64}, std::size_t{16384}));
  option(app, "max-head-bytes", c.max_head_bytes, "largest request line with headers")
      ->check(CLI::Range(std::size_t{1024}, std::size_t{65536}));
  option(app, "idle-s", c.idle_s, "an idle connection is closed after")->check(seconds);
  option(app, "head-s", c.head_s, "time for a request's head")->check(seconds);
  option(app, "body-s", c.body_s, "time for a request's body")->check(seconds);
  option(app, "write-s", c.write_s, "time for the client to take an answer")->check(seconds);
  option(app, "drain-delay-s", c.drain_delay_s,
         "time to keep accepting, while not ready, when SIGTERM arrives")
      ->check(number(0.0, 3600.0));
  option(app, "drain-s", c.drain_s, "time for accepted work when SIGTERM arrives")->check(seconds);
  option(app, "log-level", c.log_level, "minimum level of the jobs' lines on stdout")
      ->check(CLI::IsMember(std::vector<std::string>{"info", "warning", "error"}));
  option(app, "log-queue", c.log_queue, "log lines kept for a slow reader of stdout")
      ->check(CLI::Range(std::size_t{16}, std::size_t{1u << 20}));
  option(app, "log-directory", c.log_directory,
         "folder for <day>/<identity>~<job>.jsonl, with --keys; if empty, no files");
  option(app, "log-day-files", c.log_day.files, "files a day's folder may hold")
      ->check(CLI::Range(std::size_t{1}, std::size_t{10'000'000}));
  option(app, "log-key-files", c.log_day.key_files, "of those, one key's at most; 0: half")
      ->check(CLI::Range(std::size_t{0}, std::size_t{10'000'000}));
  option(app, "log-key-bytes", c.log_day.key_bytes,
         "bytes that one key's files may hold a day; 0: half")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1} << 40));
  option(app, "log-day-bytes", c.log_day.bytes, "bytes a day's folder may hold")
      ->check(CLI::Range(std::size_t{4096}, std::size_t{1} << 40));
}

/// The file of the environment must exist, as one named on the command line must.
void add_file(CLI::App& app) {
  const char* variable = std::getenv("TUBECUT_CONFIG");
  const std::string from_environment = variable == nullptr ? "" : variable;
  app.set_config("--config", from_environment, "TOML file with these options",
                 !from_environment.empty());
  app.allow_config_extras(CLI::config_extras_mode::error);  // a typo is not passed over
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// Returns the number of a line of the file that sets a value without a name, because the parser
/// ignores it; 0 if no such line exists.
int nameless_line(const std::string& file) {
  std::ifstream in(file);
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const auto first = line.find_first_not_of(" \t");
    if (first != std::string::npos && line[first] == '=') return number;
  }
  return 0;
}

/// Adds the commands other than serving, each with its options.
std::vector<std::pair<Command::Kind, CLI::App*>> add_commands(CLI::App& app, Command& command) {
  auto* health = app.add_subcommand("health", "check whether the running service is ready");
  auto* run = app.add_subcommand("run", "answer a file without a server: the same bytes");
  run->add_option(
      "--endpoint", command.endpoint,
      "such as bevel-tables, whose request the file is; without it the file is a batch");
  run->add_option("--format", command.format, "of the endpoint's answer: svg, nc1, ...; else json")
      ->needs("--endpoint");
  run->add_option("--option", command.options,
                  "of the format, such as speed_mm_min=600; again for more")
      ->take_all()
      ->expected(1)
      ->needs("--format");
  run->add_option(
         "file", command.file,
         "one request, or a batch: a line {\"id\", \"endpoint\", \"body\"} per job; - for stdin")
      ->required();
  auto* selftest = app.add_subcommand("selftest", "answer known jobs and compare their hashes");
  selftest->add_flag("--all", command.all, "print the hash of every example instead");
  auto* new_key = app.add_subcommand("new-key", "print a new API key and its line for --keys");
  new_key->add_option("identity", command.identity, "whose it is")
      ->required()
      ->check(
          [](const std::string& name) {
            return sound_identity(name) ? std::string{} : "is not 1 to 64 letters, digits, . _ -";
          },
          "");
  const std::vector<std::pair<Command::Kind, CLI::App*>> all = {{Command::Kind::health, health},
                                                                {Command::Kind::run, run},
                                                                {Command::Kind::selftest, selftest},
                                                                {Command::Kind::new_key, new_key}};
  for (const auto& [kind, sub] : all) {
    sub->configurable(false);
    sub->fallthrough();  // an option of the service may also follow the command's name
    for (auto* its : sub->get_options()) its->configurable(false);
  }
  app.require_subcommand(0, 1);
  return all;
}

/// Returns an error text if options contradict each other.
std::string contradiction(const Config& c) {
  if (c.port != 0 && c.port == c.admin_port) return "--port and --admin-port must differ";
  for (const auto& network : c.trusted_proxies) {
    if (!is_network(network)) return "--trusted-proxy: no address or network: " + network;
  }
  for (const auto& origin : c.cors_origins) {
    if (!is_origin(origin))
      return "--cors-origin: not scheme://host[:port] in lower case: " + origin;
  }
  return {};
}

/// Returns true if one letter is missing, added or another, or two neighbours are swapped.
bool one_slip_apart(std::string_view a, std::string_view b) {
  while (!a.empty() && !b.empty() && a.front() == b.front()) a.remove_prefix(1), b.remove_prefix(1);
  while (!a.empty() && !b.empty() && a.back() == b.back()) a.remove_suffix(1), b.remove_suffix(1);
  if (a.size() == 2 && b.size() == 2) return a[0] == b[1] && a[1] == b[0];
  return a.size() <= 1 && b.size() <= 1;
}

/// The first TUBECUT_ variable of the environment that names no option but nearly does, and the one
/// that it means. Other programs have variables of that prefix too, so the rest is theirs.
std::string misspelled_variable(const CLI::App& app) {
  constexpr std::string_view kPrefix = "TUBECUT_";
  std::vector<std::string> known{"CONFIG"};
  for (const auto* option : app.get_options())
    if (const auto& name = option->get_envname(); name.starts_with(kPrefix))
      known.push_back(name.substr(kPrefix.size()));
  const auto others = {"KEY", "URL"};  // of the clients
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string_view text = *variable;
    if (!text.starts_with(kPrefix)) continue;
    const auto name = text.substr(kPrefix.size(), text.find('=') - kPrefix.size());
    const auto is_name = [&](std::string_view one) { return one == name; };
    if (std::ranges::any_of(known, is_name) || std::ranges::any_of(others, is_name)) continue;
    const auto near = std::ranges::find_if(
        known, [&](const std::string& one) { return one_slip_apart(name, one); });
    const bool two_slips = name.size() != 5 && name.size() != 6;  // too many words are so near
    const auto meant = near != known.end() ? *near
                       : two_slips         ? api::slip_of(name, known)
                                           : std::string();
    if (!meant.empty())
      return fmt::format("{0}{1} in the environment names no option; {0}{2} does", kPrefix, name,
                         meant);
  }
  return {};
}

}  // namespace

tl::expected<Command, Exit> read_command(int argc, const char* const* argv) {
  Command command;
  Config& c = command.config;
  bool print = false;
  CLI::App app{"tubecut: cuts and bevels of tube joints over HTTP", "tubecut-server"};
  app.set_version_flag("--version", fmt::format("{}, numerics {}", api::engine(), api::numerics()));
  add_network(app, c);
  add_limits(app, c);
  add_file(app);
  app.add_flag("--print-config", print, "print every option's value as TOML and end")
      ->configurable(false);
  const auto commands = add_commands(app, command);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& end) {
    std::ostringstream out;
    std::ostringstream err;
    const int code = app.exit(end, out, err);
    return tl::unexpected(Exit{code == 0 ? 0 : 2, out.str(), err.str()});
  }
  const auto file = app.get_config_ptr()->as<std::string>();
  if (const int line = nameless_line(file); line > 0)
    return tl::unexpected(Exit{2, {}, fmt::format("{}: line {} sets nothing\n", file, line)});
  if (auto why = misspelled_variable(app); !why.empty())
    return tl::unexpected(Exit{2, {}, why + '\n'});
  for (auto* list : {&c.cors_origins, &c.trusted_proxies, &c.hosts}) std::erase(*list, "");
  if (auto why = contradiction(c); !why.empty()) return tl::unexpected(Exit{2, {}, why + '\n'});
  if (print) return tl::unexpected(Exit{0, app.config_to_str(true, false), {}});
  if (c.replica.empty()) c.replica = host_name();
  for (const auto& [kind, parsed] : commands)
    if (parsed->parsed()) command.kind = kind;
  return command;
}

}  // namespace tubecut::server
