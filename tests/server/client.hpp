#pragma once

#include <sys/types.h>

#include <string>
#include <string_view>
#include <vector>

namespace tubecut::test {

/// One answer as it came over the wire.
struct Answer {
  int status = 0;  // 0: no answer came
  std::string head;
  std::string body;

  /// Value of a header, empty when it is not there; compared in lower case.
  [[nodiscard]] std::string header(std::string_view name) const;
};

/// A plain TCP client of this machine that shares no code with the server's transport.
class Client {
 public:
  explicit Client(int port);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void send(std::string_view bytes);
  /// Announces the end of the input.
  void half_close() const;
  /// The next answer, read by its Content-Length; without body for HEAD and 100.
  [[nodiscard]] Answer receive(bool head_only = false);
  /// True when the server has ended the connection and nothing is left to read.
  [[nodiscard]] bool at_end();

 private:
  bool fill();

  int descriptor_;
  std::string in_;
};

[[nodiscard]] std::string get(std::string_view target, std::string_view headers = {});
[[nodiscard]] std::string post(std::string_view target, std::string_view body,
                               std::string_view headers = {});

/// A running program and its standard output.
class Program {
 public:
  explicit Program(const std::vector<std::string>& arguments);
  ~Program();  // kills it when it still runs
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Next line of its output without the line's end; empty at the end or after 10 s.
  [[nodiscard]] std::string line();
  void signal(int number) const;
  /// Its exit code (128 + signal when killed); -1 when it does not end within 12 s.
  [[nodiscard]] int exit_code();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  std::string in_;
};

}  // namespace tubecut::test
