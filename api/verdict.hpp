#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace tubecut::api {

struct FormatName;
struct FormatOptions;
struct Json;
struct Problem;

/// The service's classification of an answer.
struct Verdict {
  std::string_view status = "ok";          // ok, review, reject
  std::vector<std::string> reasons = {};   // as in the answer
  std::vector<std::string> warnings = {};  // of severity `cut`: code, pointer, detail
  std::vector<std::string> codes = {};     // theirs, each once
  struct Excess {
    std::string_view name;  // as in `accept`
    double value = 0.0, limit = 0.0;
  };
  std::vector<Excess> excess = {};  // the reasons for rejection
};

/// A measured value of an answer, to compare with the request's own `accept`.
struct Measure {
  std::string_view name;  // as in `accept`, for example "max_b_deg"
  double value = 0.0;
};

/// Returns `reject` if a measure exceeds its limit, or is below a limit called `min_...`; else
/// `review` if a warning has severity `cut`; else `ok`. `request`: with defaults applied, for the
/// warnings' pointers.
[[nodiscard]] Verdict judge(const std::vector<Warning>& warnings, const Json& request,
                            const std::vector<Measure>& measures,
                            const std::vector<Measure>& accepted);

/// Maximum size of a verdict in a file.
struct VerdictRoom {
  std::size_t width = 100;    // characters a line; longer ones go on after "... "
  std::size_t warnings = 40;  // of more, the rest are counted
  bool plain = false;         // in plain words: no codes, no names on the wire
};

/// Returns the lines for the head of every file, in any format: status, reasons, warnings of
/// severity `cut`. Not escaped: the text may be a client's.
[[nodiscard]] std::vector<std::string> verdict_lines(const Verdict& verdict, VerdictRoom room = {});

/// Status and reasons, each once: "review: free_end, standoff".
[[nodiscard]] std::string verdict_in_short(const Verdict& verdict);

/// Returns the reason why this answer is not printed in a machine format: it is for comparison
/// only; or, if the torch is lit, its verdict is `reject` (`rejected`), or `review` and the
/// acknowledged codes differ from its warnings (`not_acknowledged`, which lists the missing and the
/// surplus ones).
[[nodiscard]] std::optional<Problem> refuse_to_cut(const Verdict& verdict, const FormatName& format,
                                                   const FormatOptions& options);

/// The value of the header Tubecut-Verdict, a structured field (RFC 8941): the status, with the
/// reasons as a parameter, each once: `review;reasons="free_end, standoff"`.
[[nodiscard]] std::string verdict_header(const Verdict& verdict);

}  // namespace tubecut::api
