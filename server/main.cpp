#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <exception>

#include "server/access.hpp"
#include "server/config.hpp"
#include "server/machine_files.hpp"
#include "server/selftest.hpp"
#include "server/serve.hpp"

namespace {

/// Closed ones of the three would be the numbers of the next files and sockets opened, and log
/// lines would go there.
void keep_standard_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) != -1) continue;
    if (::open("/dev/null", O_RDWR) != descriptor) ::_exit(1);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  namespace server = tubecut::server;
  keep_standard_descriptors();
  const auto command = server::read_command(argc, argv);
  if (!command) {
    std::fputs(command.error().out.c_str(), stdout);
    std::fputs(command.error().err.c_str(), stderr);
    return command.error().code;
  }
  for (const auto& wrong :
       {server::load_machines(command->config.machines), server::load_posts(command->config.posts)})
    if (!wrong.empty()) {
      std::fprintf(stderr, "tubecut-server: %s\n", wrong.c_str());
      return 1;
    }
  switch (command->kind) {
    case server::Command::Kind::health:
      return server::health(command->config);
    case server::Command::Kind::run:
      return server::run(*command);
    case server::Command::Kind::selftest:
      return server::selftest(command->all);
    case server::Command::Kind::new_key: {
      const auto made = server::make_key(command->identity);
      std::printf("the key, shown this once:\n%s\nits line for --keys:\n%s\n", made.key.c_str(),
                  made.line.c_str());
      return 0;
    }
    case server::Command::Kind::serve:
      return server::serve(command->config);
  }
} catch (const std::exception& failure) {
  std::fprintf(stderr, "tubecut-server: %s\n", failure.what());
  return 1;
}
