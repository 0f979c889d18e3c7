#include "server/status.hpp"

namespace tubecut::server {

int status_of(ErrorKind kind) {
  switch (kind) {  // no default, so that the compiler requires a row for each new kind
    case ErrorKind::unreadable:
      return 400;
    case ErrorKind::unauthorized:
      return 401;
    case ErrorKind::forbidden:
      return 403;
    case ErrorKind::not_found:
      return 404;
    case ErrorKind::method_not_allowed:
      return 405;
    case ErrorKind::not_acceptable:
      return 406;
    case ErrorKind::conflict:
      return 409;
    case ErrorKind::too_large:
      return 413;
    case ErrorKind::unsupported_media:
      return 415;
    case ErrorKind::invalid:
      return 422;
    case ErrorKind::no_solution:
      return 422;
    case ErrorKind::overloaded:
      return 429;
    case ErrorKind::internal:
      return 500;
    case ErrorKind::unavailable:
      return 503;
    case ErrorKind::timeout:
      return 504;
  }
  return 500;
}

bool retryable(int status) { return status == 429 || status == 502 || status == 503; }

}  // namespace tubecut::server
