#pragma once

#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "server/observe/job_files.hpp"

namespace tubecut::server {

/// Everything that can be set, with its default. Read and checked once, at start.
struct Config {
  std::string host = "127.0.0.1";
  int port = 8080;  // 0: any free one, named in the ready line
  std::string admin_host = "127.0.0.1";
  int admin_port = 9090;
  std::string machines;  // folder of the user's machines; empty: not used
  std::string posts;     // the same of posts
  std::string replica;   // empty: the host's name
  std::string keys;      // file of API keys; empty: no keys required
  bool open = false;     // serve beyond this machine without keys
  std::vector<std::string> cors_origins;
  std::vector<std::string> trusted_proxies;
  std::vector<std::string> hosts;  // names it is called by besides its own; "*": any
  int connections = 4096;
  int connections_per_client = 0;  // 0: half of them
  int slots = 0;                   // 0: as many as there are CPUs for this process
  std::size_t queue = 64;
  std::size_t memory_bytes = 0;  // for bodies, jobs and answers; 0: a fraction of the available
                                 // memory
  double budget_s = 0.0;         // CPU of any job; 0: the endpoint's default
  std::size_t max_body_bytes = 8u << 20;
  std::size_t max_target_bytes = 8192;
  std::size_t max_head_bytes = 16384;
  double idle_s = 15.0;
  double head_s = 3.0;
  double body_s = 10.0;
  double write_s = 10.0;
  double drain_delay_s = 0.0;      // between "not ready" and the end of accepting
  double drain_s = 8.0;            // for accepted work, after that
  std::string log_level = "info";  // minimum level of the jobs' lines
  std::size_t log_queue = 4096;
  std::string log_directory;  // folder for one file per job; empty: not used
  DayBounds log_day = {};     // of each day's folder there
};

/// The command that the command line selects.
struct Command {
  enum class Kind { serve, health, run, selftest, new_key };
  Kind kind = Kind::serve;
  Config config;
  std::string endpoint;              // of run: "bevel-tables"; empty: the file is a batch
  std::string format;                // of run with an endpoint; empty: JSON
  std::vector<std::string> options;  // the format's: "speed_mm_min=600"
  std::string file;                  // of run: "-" for stdin
  std::string identity;              // of new-key
  bool all = false;                  // of selftest: every example, its hash printed
};

/// An end before any work: help, version, the printed configuration, or a mistake in the options.
struct Exit {
  int code = 0;
  std::string out;
  std::string err;
};

/// Reads command line, TOML file and TUBECUT_* environment. If several set the same option, the
/// first of these three takes precedence.
[[nodiscard]] tl::expected<Command, Exit> read_command(int argc, const char* const* argv);

}  // namespace tubecut::server
