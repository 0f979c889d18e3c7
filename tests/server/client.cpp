#include "tests/server/client.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace tubecut::test {
namespace {

constexpr int kPatienceMs = 10000;

std::string lower(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return std::tolower(c); });
  return out;
}

bool read_some(int descriptor, std::string& into) {
  pollfd who{.fd = descriptor, .events = POLLIN, .revents = 0};
  if (poll(&who, 1, kPatienceMs) <= 0) return false;
  std::array<char, 65536> bytes{};
  const auto n = ::read(descriptor, bytes.data(), bytes.size());
  if (n <= 0) return false;
  into.append(bytes.data(), static_cast<std::size_t>(n));
  return true;
}

}  // namespace

std::string Answer::header(std::string_view name) const {
  const std::string all = lower(head);
  const std::string key = "\r\n" + lower(name) + ": ";
  const auto at = all.find(key);
  if (at == std::string::npos) return {};
  const auto from = at + key.size();
  return head.substr(from, head.find("\r\n", from) - from);
}

Client::Client(int port) : descriptor_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto* generic = static_cast<const sockaddr*>(static_cast<const void*>(&address));
  if (connect(descriptor_, generic, sizeof address) != 0) throw std::runtime_error("connect");
}

Client::~Client() { close(descriptor_); }

void Client::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const auto n = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (n <= 0) return;  // the server ended the connection: the answer gives the reason
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void Client::half_close() const { ::shutdown(descriptor_, SHUT_WR); }

bool Client::fill() { return read_some(descriptor_, in_); }

Answer Client::receive(bool head_only) {
  std::size_t end = 0;
  while ((end = in_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) return {};
  }
  Answer answer;
  answer.head = in_.substr(0, end + 2);
  answer.status = std::stoi(in_.substr(9, 3));
  in_.erase(0, end + 4);
  const auto length = answer.header("Content-Length");
  const std::size_t wanted = head_only || length.empty() ? 0 : std::stoul(length);
  while (in_.size() < wanted && fill()) {
  }
  answer.body = in_.substr(0, wanted);
  in_.erase(0, wanted);
  return answer;
}

bool Client::at_end() {
  if (!in_.empty()) return false;
  pollfd who{.fd = descriptor_, .events = POLLIN, .revents = 0};
  if (poll(&who, 1, kPatienceMs) <= 0) return false;
  char byte = 0;
  return recv(descriptor_, &byte, 1, 0) == 0;
}

std::string get(std::string_view target, std::string_view headers) {
  return "GET " + std::string(target) + " HTTP/1.1\r\nHost: localhost\r\n" + std::string(headers) +
         "\r\n";
}

std::string post(std::string_view target, std::string_view body, std::string_view headers) {
  return "POST " + std::string(target) +
         " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
         std::to_string(body.size()) + "\r\n" + std::string(headers) + "\r\n" + std::string(body);
}

Program::Program(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  std::vector<std::string> words = arguments;
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int failed = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  output_ = ends[0];
  if (failed != 0) throw std::runtime_error("posix_spawn " + arguments.front());
}

Program::~Program() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(output_);
}

std::string Program::line() {
  std::size_t end = 0;
  while ((end = in_.find('\n')) == std::string::npos) {
    if (!read_some(output_, in_)) return {};
  }
  std::string out = in_.substr(0, end);
  in_.erase(0, end + 1);
  return out;
}

void Program::signal(int number) const { kill(pid_, number); }

int Program::exit_code() {
  for (int waited_ms = 0; waited_ms < 12000; waited_ms += 5) {
    int status = 0;
    if (waitpid(pid_, &status, WNOHANG) == pid_) {
      pid_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return -1;
}

}  // namespace tubecut::test
