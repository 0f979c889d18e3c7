#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tubecut::api {

// Names of the wire names in docs/glossary.md, for files that people read. The console reads the
// same lists (web/src/words.ts).

enum class Term { field, value };

struct Word {
  Term kind;
  std::string_view name, called;
};

/// Every row, by kind and name; made from the glossary (tools/embed_words.py).
[[nodiscard]] std::span<const Word> glossary();

/// Returns the name of a field, or of a value (a choice, a warning's code); without a row, its wire
/// name with blanks.
[[nodiscard]] std::string called(std::string_view name, Term kind);

/// A sentence of the service for people: names and pointers in words, numbers short, one sign for
/// degrees. A client's own words stay, unless one of them is a name on the wire.
[[nodiscard]] std::string in_plain_words(std::string_view sentence);

}  // namespace tubecut::api
