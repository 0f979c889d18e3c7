#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tubecut::api {

// What docs/glossary.md calls the names on the wire, for files that people read. The console reads
// the same lists (web/src/words.ts).

enum class Term { field, value };

struct Word {
  Term kind;
  std::string_view name, called;
};

/// Every row, by kind and name; made from the glossary (tools/embed_words.py).
[[nodiscard]] std::span<const Word> glossary();

/// What a field, or a value (a choice, a warning's code), is called; without a row its name, with
/// blanks.
[[nodiscard]] std::string called(std::string_view name, Term kind);

/// A sentence of the service for people: names and pointers in words, numbers short, one sign for
/// degrees. A client's own words stay, unless one of them is a name on the wire.
[[nodiscard]] std::string in_plain_words(std::string_view sentence);

}  // namespace tubecut::api
