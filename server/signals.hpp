#pragma once

#include <functional>

namespace tubecut::server {

/// Stop and reload requests from outside. Make it first in main, because threads inherit the signal
/// mask.
class Signals {
 public:
  Signals();

  /// Waits for SIGTERM or SIGINT (or `raise_stop`), calling `hang_up` at each SIGHUP until then.
  /// From then on a second one ends the process at once.
  void wait(const std::function<void()>& hang_up) const;

  /// Wakes `wait` from inside.
  static void raise_stop();
};

}  // namespace tubecut::server
