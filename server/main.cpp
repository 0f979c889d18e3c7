#include <cstdio>
#include <exception>

#include "server/config.hpp"
#include "server/serve.hpp"

int main(int argc, char** argv) try {
  using namespace tubecut::server;
  const auto command = read_command(argc, argv);
  if (!command) {
    std::fputs(command.error().out.c_str(), stdout);
    std::fputs(command.error().err.c_str(), stderr);
    return command.error().code;
  }
  switch (command->kind) {
    case Command::Kind::health:
      return health(command->config);
    case Command::Kind::run:
      return run(*command);
    case Command::Kind::serve:
      return serve(command->config);
  }
} catch (const std::exception& failure) {
  std::fprintf(stderr, "tubecut-server: %s\n", failure.what());
  return 1;
}
