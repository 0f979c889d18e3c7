#include "server/admin.hpp"

#include "api/api.hpp"
#include "server/identity.hpp"
#include "server/status.hpp"

namespace tubecut::server {
namespace {

Response plain(int status, std::string body) {
  return {.status = status,
          .content_type = "text/plain; charset=utf-8",
          .headers = {{"Cache-Control", "no-store"}},
          .body = std::move(body)};
}

Response refuse(ErrorCode code, std::string_view detail) {
  api::Outcome outcome =
      api::problem(code, detail, random_id(), {.clock = {}, .status = status_of});
  return {.status = status_of(outcome.error.value_or(ErrorKind::internal)),
          .content_type = std::move(outcome.content_type),
          .headers = std::move(outcome.headers),
          .body = std::move(outcome.body)};
}

}  // namespace

Response admin(const Request& request, const AdminSources& sources) {
  if (request.refusal) return refuse(request.refusal->code, request.refusal->detail);
  if (!called_by(header(request.headers, "Host"), sources.hosts))
    return refuse(ErrorCode::bad_request, kForeignHost);
  const auto path = path_of(request.target);
  const bool known = path == "/livez" || path == "/readyz" || path == "/metrics";
  if (!known)
    return refuse(ErrorCode::not_found, "The admin port has /livez, /readyz and /metrics.");
  if (request.method != "GET" && request.method != "HEAD") {
    Response response = refuse(ErrorCode::method_not_allowed, "Use GET or HEAD.");
    response.headers.emplace_back("Allow", "GET, HEAD");
    return response;
  }
  if (path == "/livez") return plain(200, "alive\n");
  if (path == "/readyz")
    return sources.ready() ? plain(200, "ready " + api::configuration_sha256() + "\n")
                           : plain(503, "not ready\n");
  Response response = plain(200, sources.metrics());
  response.content_type = "text/plain; version=0.0.4; charset=utf-8";
  return response;
}

}  // namespace tubecut::server
