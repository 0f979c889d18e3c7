#include "server/access.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/app.hpp"
#include "server/http/networks.hpp"
#include "server/jobs/capacity.hpp"
#include "server/observe/job_files.hpp"

namespace tubecut::server {
namespace {

std::string file_with(const std::string& name, const std::string& text) {
  std::string path = ::testing::TempDir() + std::to_string(getpid()) + name;
  std::ofstream(path) << text;
  return path;
}

Headers bearer(const std::string& key) { return {{"Authorization", "Bearer " + key}}; }

TEST(Keys, AreReadByTheLineAndNeverShown) {
  // SHA-256 of "abc", FIPS 180-2.
  const std::string abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
  const auto keys = parse_keys("# cells\n\nmes " + abc + "\ncell-3 " + abc + " 2.5 # slow\n");
  ASSERT_TRUE(keys) << keys.error();
  ASSERT_EQ(keys->size(), 2U);
  EXPECT_EQ((*keys)[0].identity, "mes");
  EXPECT_EQ((*keys)[0].per_second, 0.0);
  EXPECT_EQ((*keys)[1].per_second, 2.5);
  EXPECT_EQ((*keys)[0].sha256[0], 0xba);
  for (const std::string& wrong :
       std::vector<std::string>{std::string(), "mes", "mes abc", "m/es " + abc, "mes " + abc + "00",
                                "mes " + abc + " 0", "mes " + abc + " x", "mes " + abc + " 1 2"}) {
    const auto refused = parse_keys("# first\n" + wrong + "\n");
    ASSERT_FALSE(refused) << wrong;
    EXPECT_EQ(refused.error().find("ba78"), std::string::npos) << refused.error();
  }
}

TEST(Access, IdentifiesClientByKey) {
  const auto mes = make_key("mes");
  const auto cell = make_key("cell");
  EXPECT_NE(mes.key, cell.key);
  EXPECT_EQ(mes.line.find(mes.key), std::string::npos);
  const auto file = file_with("tubecut_keys", mes.line + "\n" + cell.line + "\n");
  Access access(file);
  ASSERT_EQ(access.load(), "");
  EXPECT_EQ(access.identify(bearer(mes.key)), "mes");
  EXPECT_EQ(access.identify({{"x-api-key", cell.key}}), "cell");
  for (const Headers& headers : {Headers{}, bearer(""), bearer(mes.key + "x"),
                                 bearer(mes.key.substr(1)), Headers{{"Authorization", mes.key}}}) {
    ASSERT_FALSE(access.identify(headers));
    EXPECT_EQ(access.identify(headers).error().code, ErrorCode::unauthorized);
  }
  std::ofstream(file) << cell.line << "\n";
  EXPECT_EQ(access.load(), "");
  EXPECT_FALSE(access.identify(bearer(mes.key)));
  EXPECT_EQ(access.identify(bearer(cell.key)), "cell");
  std::ofstream(file) << "nonsense\n";
  EXPECT_NE(access.load(), "");
  EXPECT_EQ(access.identify(bearer(cell.key)), "cell");  // as it was
}

TEST(Access, GivesEachIdentityItsOwnRate) {
  const auto slow = make_key("slow");
  const auto fast = make_key("fast");
  Access access(file_with("tubecut_rates", slow.line + " 2\n" + fast.line + "\n"));
  ASSERT_EQ(access.load(), "");
  int taken = 0;
  for (int i = 0; i <= 1000; ++i) {  // 10 s, a hundred a second
    const double now = 1000.0 + 0.01 * i;
    if (!access.take_rate_token("slow", now)) ++taken;
    EXPECT_FALSE(access.take_rate_token("fast", now));
  }
  EXPECT_GE(taken, 21);
  EXPECT_LE(taken, 22);  // the burst of one second, then two a second
  const auto refusal = access.take_rate_token("slow", 1010.0);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->code, ErrorCode::rate_limited);
  EXPECT_EQ(refusal->retry_after_s, 1);
}

/// The clients of the fair queue: owners of keys, from any address; without keys, addresses, also
/// those that a trusted proxy names.
TEST(Access, NamesTheClientForTheFairQueue) {
  const auto mes = make_key("mes");
  const auto cell = make_key("cell");
  AppOptions options;
  options.trusted_proxies = {"10.0.0.1"};
  const auto client = [&options](const std::string& key, const std::string& peer) {
    Request asked{.method = "GET", .target = "/v1/tubes", .peer = peer};
    asked.headers = {{"X-Api-Key", key}, {"X-Forwarded-For", "192.168.7.7"}};
    return App(options).client(asked);
  };
  EXPECT_EQ(client(mes.key, "192.168.1.1"), client(cell.key, "192.168.1.1"));
  EXPECT_NE(client(mes.key, "192.168.1.1"), client(mes.key, "192.168.1.2"));
  EXPECT_NE(client(mes.key, "10.0.0.1"), client(mes.key, "10.0.0.2"));
  EXPECT_EQ(client(mes.key, "10.0.0.1"), client(mes.key, "192.168.7.7"));
  options.access = std::make_shared<Access>(
      file_with("tubecut_clients_keys", mes.line + "\n" + cell.line + "\n"));
  ASSERT_EQ(options.access->load(), "");
  EXPECT_NE(client(mes.key, "192.168.1.1"), client(cell.key, "192.168.1.1"));
  EXPECT_EQ(client(mes.key, "192.168.1.1"), client(mes.key, "192.168.1.2"));
}

TEST(Access, IsCheckedBeforeTheJobAndNamedInItsRecord) {
  const auto key = make_key("mes");
  auto access = std::make_shared<Access>(file_with("tubecut_app_keys", key.line + "\n"));
  ASSERT_EQ(access->load(), "");
  std::vector<JobRecord> records;
  int jobs = 0;
  AppOptions options;
  options.access = access;
  options.dispatch = [&](const api::Call&, const api::Context&) {
    ++jobs;
    return api::Outcome{
        .error = {}, .content_type = "text/plain", .body = "x", .headers = {}, .job = {}};
  };
  options.finished = [&](const JobRecord& record) { records.push_back(record); };
  const App app(options);
  Request request{.method = "POST", .target = "/v1/x"};
  const auto refused = app.handle(request);
  EXPECT_EQ(refused.status, 401);
  EXPECT_EQ(header(refused.headers, "WWW-Authenticate"), "Bearer");
  EXPECT_EQ(app.screen(request)->code, ErrorCode::unauthorized);
  EXPECT_EQ(jobs, 0);
  request.headers = bearer(key.key);
  EXPECT_EQ(app.handle(request).status, 200);
  EXPECT_EQ(records.back().identity, "mes");
}

TEST(Networks, ContainTheirAddresses) {
  EXPECT_TRUE(in_networks("10.1.2.3", {"10.0.0.0/8"}));
  EXPECT_FALSE(in_networks("11.1.2.3", {"10.0.0.0/8"}));
  EXPECT_TRUE(in_networks("::ffff:10.1.2.3", {"10.1.2.3"}));
  EXPECT_TRUE(in_networks("fd00::1", {"10.0.0.0/8", "fd00::/8"}));
  EXPECT_FALSE(in_networks("10.1.2.3", {"fd00::/8", "nonsense", "10.0.0.0/33"}));
  EXPECT_TRUE(in_networks("1.2.3.4", {"0.0.0.0/0"}));
  EXPECT_FALSE(in_networks("fd00::1", {"0.0.0.0/0"}));
  for (const auto* host : {"127.0.0.1", "127.9.9.9", "::1", "localhost"}) {
    EXPECT_TRUE(is_loopback(host)) << host;
  }
  for (const auto* host : {"0.0.0.0", "::", "192.168.1.2", "example.org", ""}) {
    EXPECT_FALSE(is_loopback(host)) << host;
  }
}

TEST(Networks, AreReadToTheirEnd) {
  for (const auto* good : {"10.0.0.0/8", "10.1.2.3", "::1", "fd00::/8", "0.0.0.0/0"}) {
    EXPECT_TRUE(is_network(good)) << good;
  }
  for (const auto* bad : {"10.0.0.0/8,127.0.0.0/8", "10.0.0.0/8 ", "10.0.0.0/8junk", "10.0.0.0/",
                          "10.0.0.0/-1", "10.0.0.0/+8", "10.0.0.0/33", "10.0.0", ""}) {
    EXPECT_FALSE(is_network(bad)) << bad;
  }
}

TEST(Origins, AreAsABrowserSendsThem) {
  for (const auto* good : {"https://plant.example", "http://127.0.0.1:8080", "http://[::1]:5173",
                           "capacitor://localhost"}) {
    EXPECT_TRUE(is_origin(good)) << good;
  }
  for (const auto* bad : {"https://plant.example/", "https://Plant.example", "plant.example", "*",
                          "null", "https://", "://a", "https://a.b,http://c.d", "https://a.b x"}) {
    EXPECT_FALSE(is_origin(bad)) << bad;
  }
}

TEST(Client, IsThePeerUnlessAProxyOfOursSpeaks) {
  const std::vector<std::string> proxies = {"10.0.0.0/8"};
  Request request{.headers = {{"X-Forwarded-For", "6.6.6.6, 1.2.3.4"}}, .peer = "9.9.9.9"};
  EXPECT_EQ(client_of(request, proxies), "9.9.9.9");
  EXPECT_EQ(client_of(request, {}), "9.9.9.9");
  request.peer = "10.0.0.1";
  EXPECT_EQ(client_of(request, proxies), "1.2.3.4");
  request.headers = {{"X-Forwarded-For", "1.2.3.4, 10.0.0.7"}};
  EXPECT_EQ(client_of(request, proxies), "1.2.3.4");
  request.headers = {{"X-Forwarded-For", "evil\r\n"}};
  EXPECT_EQ(client_of(request, proxies), "10.0.0.1");
}

TEST(Capacity, FollowsTheQuotaRoundedUp) {
  EXPECT_EQ(slots_of_quota("100000 100000"), 1);
  EXPECT_EQ(slots_of_quota("100001 100000"), 2);
  EXPECT_EQ(slots_of_quota("50000 100000"), 1);
  EXPECT_EQ(slots_of_quota("400000 100000"), 4);
  for (const auto* none : {"max 100000", "", "0 100000", "x y"}) EXPECT_EQ(slots_of_quota(none), 0);
  const auto root = ::testing::TempDir() + "tubecut_group";
  ASSERT_EQ(std::system(("mkdir -p " + root + "/a/b").c_str()), 0);
  std::ofstream(root + "/a/cpu.max") << "100000 100000\n";
  std::ofstream(root + "/a/b/memory.max") << "268435456\n";
  const auto self = file_with("tubecut_group_of", "0::/a/b\n");
  const auto can = capacity(root, self);
  EXPECT_EQ(can.slots, 1);
  EXPECT_EQ(can.slots_from, "cgroup");
  EXPECT_EQ(can.memory_from, "cgroup");
  EXPECT_LT(can.memory, 268435456U);
  EXPECT_GT(can.memory, 134217728U);
  EXPECT_NE(capacity("/nowhere", "/nowhere").slots_from, "cgroup");
}

// A host of version 1: controllers in folders of their own, each with a group of its own; both
// versions side by side.
TEST(Capacity, ReadsBothVersionsOfControlGroups) {
  const auto root = ::testing::TempDir() + "tubecut_group_v1";
  ASSERT_EQ(
      std::system(
          ("mkdir -p " + root + "/cpu/x/y " + root + "/memory/m " + root + "/cpuset/x/y").c_str()),
      0);
  const auto self =
      file_with("tubecut_group_of_v1",
                "9:cpuset:/x/y\n4:memory:/m\n3:cpu,cpuacct:/x/y\n1:name=systemd:/x\n0::/\n");
  std::ofstream(root + "/cpu/x/cpu.cfs_period_us") << "100000\n";
  std::ofstream(root + "/cpu/x/y/cpu.cfs_period_us") << "100000\n";
  std::ofstream(root + "/cpu/x/y/cpu.cfs_quota_us") << "-1\n";
  std::ofstream(root + "/memory/m/memory.limit_in_bytes") << "9223372036854771712\n";
  std::ofstream(root + "/cpu/x/cpu.cfs_quota_us") << "-1\n";
  const auto free = capacity(root, self);
  EXPECT_NE(free.slots_from, "cgroup");
  EXPECT_EQ(free.memory_from, "machine");
  std::ofstream(root + "/cpu/x/cpu.cfs_quota_us") << "90000\n";
  std::ofstream(root + "/memory/m/memory.limit_in_bytes") << "268435456\n";
  const auto bound = capacity(root, self);
  EXPECT_EQ(bound.slots, 1);
  EXPECT_EQ(bound.slots_from, "cgroup");
  EXPECT_EQ(bound.memory_from, "cgroup");
  EXPECT_LT(bound.memory, 268435456U);
}

TEST(JobFiles, KeepOneFilePerJobInsideTheirFolder) {
  EXPECT_EQ(file_name_of("mes", "order-17_a.b"), "mes~order-17_a.b");
  for (const auto* id : {"../../etc/passwd", ".hidden", "a/b", "a b", "", "\xc3\xa4"}) {
    const auto name = file_name_of("mes", id);
    EXPECT_EQ(name.substr(0, 7), "mes~id-") << id;
    EXPECT_EQ(name.size(), 39U) << id;
    EXPECT_EQ(name.find('/'), std::string::npos);
  }
  EXPECT_NE(file_name_of("mes", "a b"), file_name_of("mes", "a/b"));
  const auto folder = ::testing::TempDir() + "tubecut_jobs";
  ASSERT_EQ(std::system(("rm -rf " + folder + " && mkdir " + folder).c_str()), 0);
  {
    JobFiles files(folder);
    files.write("2024-03-01", "mes", "order-17", "one\n");
    files.write("2024-03-01", "mes", "order-17", "two\n");
    files.write("2024-03-01", "mes", "../evil", "three\n");
  }
  std::ifstream in(folder + "/2024-03-01/mes~order-17.jsonl");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(text, "one\ntwo\n");
  EXPECT_FALSE(std::ifstream(folder + "/evil.jsonl"));
  ASSERT_EQ(::mkfifo((folder + "/2024-03-01/mes~stuck.jsonl").c_str(), 0600), 0);
  {
    JobFiles files(folder);
    files.write("2024-03-01", "mes", "stuck", "never read\n");
    files.write("2024-03-01", "mes", "order-18", "after it\n");
    for (int i = 0; i < 5000 && !std::ifstream(folder + "/2024-03-01/mes~order-18.jsonl"); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(files.dropped(), 1U);
  }
  EXPECT_TRUE(std::ifstream(folder + "/2024-03-01/mes~order-18.jsonl"));
  JobFiles lost("/nowhere/at/all");
  lost.write("2024-03-01", "mes", "x", "y\n");
  for (int i = 0; i < 5000 && lost.dropped() == 0; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(lost.dropped(), 1U);
}

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    out.push_back(entry.path().filename());
  std::ranges::sort(out);
  return out;
}

TEST(JobFiles, SeparateKeys) {
  const std::vector<std::string> ids = {"b~job", "job", "a~b", "../a~job", "~job"};
  std::set<std::string> names;
  for (const auto* identity : {"mes", "a", "b", "a.b"})
    for (const auto& id : ids) EXPECT_TRUE(names.insert(file_name_of(identity, id)).second) << id;
}

TEST(JobFiles, QueueIsBoundedInBytes) {
  const auto folder = ::testing::TempDir() + "tubecut_queued_jobs";
  ASSERT_EQ(std::system(("rm -rf " + folder + " && mkdir " + folder).c_str()), 0);
  {
    JobFiles files(folder, {}, 1u << 20);
    files.write("2024-03-01", "mes", "too-large", std::string(1u << 20, '.'));
    files.write("2024-03-01", "mes", "fits", std::string(1u << 19, '.'));
    EXPECT_EQ(files.dropped(), 1U);
  }
  EXPECT_EQ(files_in(folder + "/2024-03-01"), std::vector<std::string>{"mes~fits.jsonl"});
}

TEST(JobFiles, KeepAKeyToItsPart) {
  const auto folder = ::testing::TempDir() + "tubecut_parted_jobs";
  ASSERT_EQ(std::system(("rm -rf " + folder + " && mkdir -p " + folder + "/2024-03-01").c_str()),
            0);
  std::vector<std::string> told;
  std::uint64_t dropped = 0;
  {
    JobFiles files(folder, {.files = 8, .bytes = 1000}, 1u << 20,
                   [&](const std::string& identity) { told.push_back(identity); });
    for (int i = 0; i < 20; ++i) files.write("2024-03-01", "greedy", std::to_string(i), "0123");
    for (int i = 0; i < 4; ++i) files.write("2024-03-01", "modest", std::to_string(i), "0123");
    for (int i = 0; i < 5000 && files_in(folder + "/2024-03-01").size() < 8; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    dropped = files.dropped();
  }
  const auto there = files_in(folder + "/2024-03-01");
  const auto of = [&](std::string_view key) {
    return std::ranges::count_if(there, [&](const auto& name) { return name.starts_with(key); });
  };
  EXPECT_EQ(of("greedy~"), 4);
  EXPECT_EQ(of("modest~"), 4);
  EXPECT_EQ(dropped, 16U);
  EXPECT_EQ(told, std::vector<std::string>{"greedy"});  // once, not sixteen times
}

TEST(JobFiles, HoldTheBoundsOfADay) {
  const auto folder = ::testing::TempDir() + "tubecut_bounded_jobs";
  ASSERT_EQ(std::system(("rm -rf " + folder + " && mkdir " + folder).c_str()), 0);
  for (int process = 0; process < 2; ++process) {  // a new process counts what is there
    JobFiles files(folder, {.files = 3, .bytes = 100, .key_files = 3, .key_bytes = 100});
    for (int i = 0; i < 20; ++i)
      files.write("2024-03-01", "mes", "job-" + std::to_string(i), "0123456789");
    for (int i = 0; i < 20; ++i) files.write("2024-03-02", "mes", "one", "0123456789");
    for (int i = 0; i < 5000 && files.dropped() < (process == 0 ? 27U : 37U); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(files.dropped(), process == 0 ? 27U : 37U);
  }
  EXPECT_EQ(files_in(folder + "/2024-03-01").size(), 3U);
  EXPECT_EQ(std::filesystem::file_size(folder + "/2024-03-02/mes~one.jsonl"), 100U);
}

}  // namespace
}  // namespace tubecut::server
