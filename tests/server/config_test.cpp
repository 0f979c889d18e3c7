#include "server/config.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace tubecut::server {
namespace {

tl::expected<Command, Exit> read(std::vector<const char*> words) {
  words.insert(words.begin(), "tubecut-server");
  return read_command(static_cast<int>(words.size()), words.data());
}

/// An environment variable for the time of a test.
struct Variable {
  const char* name;
  Variable(const char* key, const std::string& value) : name(key) { setenv(key, value.c_str(), 1); }
  ~Variable() { unsetenv(name); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;
};

std::string file_with(const std::string& text) {
  static int files = 0;
  const std::string name = ::testing::TempDir() + "tubecut_config_" + std::to_string(getpid()) +
                           "_" + std::to_string(++files) + ".toml";
  std::ofstream(name) << text;
  return name;
}

TEST(Config, HasTheDocumentedDefaults) {
  const auto command = read({});
  ASSERT_TRUE(command) << command.error().err;
  EXPECT_EQ(command->kind, Command::Kind::serve);
  EXPECT_EQ(command->config.host, "127.0.0.1");
  EXPECT_EQ(command->config.admin_host, "127.0.0.1");
  EXPECT_EQ(command->config.port, 8080);
  EXPECT_EQ(command->config.admin_port, 9090);
  EXPECT_FALSE(command->config.replica.empty());
}

TEST(Config, RefusesAMisspelledVariableOfTheEnvironment) {
  for (const auto* name : {"TUBECUT_ADMINPORT", "TUBECUT_DRAIN_DELAYS", "TUBECUT_Port",
                           "TUBECUT_PROT", "TUBECUT_PORTT", "TUBECUT_HOSST", "TUBECUT_SLOST"}) {
    const Variable slip(name, "1");
    const auto command = read({});
    ASSERT_FALSE(command) << name;
    EXPECT_NE(command.error().err.find(name), std::string::npos) << command.error().err;
  }
  for (const auto* name : {"TUBECUT_KEY", "TUBECUT_URL", "TUBECUT_SERVICE_HOST", "TUBECUT_SEED",
                           "TUBECUT_TESTS", "TUBECUT_PARTS", "TUBECUT_SITE", "TUBECUT_RATES"}) {
    const Variable other(name, "1");
    EXPECT_TRUE(read({})) << name;
  }
}

TEST(Config, TakesCommandLineThenFileThenEnvironment) {
  const std::string name = file_with("port = 1001\nadmin-port = 1002\nhost = \"127.0.0.2\"\n");
  const Variable port("TUBECUT_PORT", "2001");
  const Variable replica("TUBECUT_REPLICA", "cell-3");
  const auto command = read({"--config", name.c_str(), "--admin-port", "3002"});
  ASSERT_TRUE(command) << command.error().err;
  EXPECT_EQ(command->config.admin_port, 3002);
  EXPECT_EQ(command->config.port, 1001);
  EXPECT_EQ(command->config.host, "127.0.0.2");
  EXPECT_EQ(command->config.replica, "cell-3");
  const auto bare = read({});
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->config.port, 2001);
}

TEST(Config, FindsItsFileByTheEnvironment) {
  const Variable good("TUBECUT_CONFIG", file_with("port = 1001\n"));
  const auto command = read({});
  ASSERT_TRUE(command) << command.error().err;
  EXPECT_EQ(command->config.port, 1001);
  const Variable missing("TUBECUT_CONFIG", "/nowhere/tubecut.toml");
  EXPECT_EQ(read({}).error().code, 2);
}

TEST(Config, PassesOverNoMistake) {
  const std::string typo = file_with("prot = 1001\n");
  const std::string nameless = file_with("port = 1001\n  = 3\n");
  const std::string bare = file_with("=\n");
  for (const std::vector<const char*>& words : {std::vector<const char*>{"--config", typo.c_str()},
                                                {"--config", nameless.c_str()},
                                                {"--config", bare.c_str()},
                                                {"--config", "/nowhere/tubecut.toml"},
                                                {"--port", "65536"},
                                                {"--port", "-1"},
                                                {"--port", "x"},
                                                {"--prot", "1"},
                                                {"--connections", "0"},
                                                {"--port", "9090"},
                                                {"--head-s", "0"},
                                                {"--budget-s", "nan"},
                                                {"--budget-s", "inf"},
                                                {"--drain-delay-s", "nan"},
                                                {"--max-body-bytes", "8388609"},
                                                {"--cors-origin", "https://a.b/"},
                                                {"--trusted-proxy", "10.0.0.0/8 127.0.0.1"},
                                                {"new-key", "line 2"},
                                                {"new-key", "#x"},
                                                {"nonsense"},
                                                {"run"}}) {
    const auto command = read(words);
    ASSERT_FALSE(command) << words[0];
    EXPECT_EQ(command.error().code, 2) << words[0];
    EXPECT_FALSE(command.error().err.empty()) << words[0];
  }
}

TEST(Config, PrintsHelpAndVersion) {
  const auto help = read({"--help"});
  ASSERT_FALSE(help);
  EXPECT_EQ(help.error().code, 0);
  for (const auto* option :
       {"--version", "--host", "--port", "--admin-port", "--config", "TUBECUT_PORT"}) {
    EXPECT_NE(help.error().out.find(option), std::string::npos) << option;
  }
  EXPECT_EQ(read({"--version"}).error().out.substr(0, 8), "tubecut ");
}

TEST(Config, PrintsAFileThatItCanRead) {
  const auto printed = read({"--port", "0", "--idle-s", "3.5", "--print-config"});
  ASSERT_FALSE(printed);
  EXPECT_EQ(printed.error().code, 0);
  const std::string name = file_with(printed.error().out);
  const auto again = read({"--config", name.c_str()});
  ASSERT_TRUE(again) << again.error().err << printed.error().out;
  EXPECT_EQ(again->config.port, 0);
  EXPECT_EQ(again->config.idle_s, 3.5);
}

TEST(Config, RefusesALineThatSetsNothing) {
  for (const auto* text : {"=\n", "port = 1001\n  = 5\n"}) {
    const std::string name = file_with(text);
    const auto command = read({"--config", name.c_str()});
    ASSERT_FALSE(command) << text;
    EXPECT_EQ(command.error().code, 2);
    EXPECT_FALSE(command.error().err.empty());
  }
}

TEST(Config, SplitsListsAtCommasInEverySource) {
  const std::vector<std::string> proxies = {"10.0.0.0/8", "127.0.0.0/8"};
  const std::vector<std::string> origins = {"https://a.b", "http://127.0.0.1:3"};
  const Variable some("TUBECUT_TRUSTED_PROXY", "10.0.0.0/8,127.0.0.0/8");
  const Variable more("TUBECUT_CORS_ORIGIN", "https://a.b,http://127.0.0.1:3");
  const auto environment = read({});
  ASSERT_TRUE(environment) << environment.error().err;
  EXPECT_EQ(environment->config.trusted_proxies, proxies);
  EXPECT_EQ(environment->config.cors_origins, origins);
  const auto line = read({"--trusted-proxy", "10.0.0.0/8,127.0.0.0/8", "--cors-origin",
                          "https://a.b", "--cors-origin", "http://127.0.0.1:3"});
  ASSERT_TRUE(line) << line.error().err;
  EXPECT_EQ(line->config.trusted_proxies, proxies);
  EXPECT_EQ(line->config.cors_origins, origins);
  const std::string name = file_with("cors-origin = [\"https://a.b\", \"http://127.0.0.1:3\"]\n");
  const auto file = read({"--config", name.c_str()});
  ASSERT_TRUE(file) << file.error().err;
  EXPECT_EQ(file->config.cors_origins, origins);
}

TEST(Config, ReadsItsCommands) {
  EXPECT_EQ(read({"health"})->kind, Command::Kind::health);
  const auto run = read({"run", "--endpoint", "bevel-tables", "a.json"});
  ASSERT_TRUE(run) << run.error().err;
  EXPECT_EQ(run->kind, Command::Kind::run);
  EXPECT_EQ(run->endpoint, "bevel-tables");
  EXPECT_EQ(run->file, "a.json");
}

}  // namespace
}  // namespace tubecut::server
