#pragma once

#include <stop_token>

#include "core/base/stop.hpp"

namespace tubecut {

/// While it lives, the work of this thread is cancelled.
class CancelledScope {
 public:
  CancelledScope() : scope_(cancelled()) {}

 private:
  static std::stop_token cancelled() {
    std::stop_source source;
    source.request_stop();
    return source.get_token();
  }
  StopScope scope_;
};

}  // namespace tubecut
