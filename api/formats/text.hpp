#pragma once

#include <string>
#include <string_view>

namespace tubecut::api {

/// Returns a number with `digits` digits after the point; never "-0.00".
[[nodiscard]] std::string fixed(double value, int digits = 2);

// Escape functions for text from a client, one per format, so that no text acts as a command in the
// output. It is UTF-8 without controls (text_encoding.hpp). In JSON (glTF) text goes through the
// Writer; STL has no text. ASCII formats spell it in ASCII, and throw Unspellable if they cannot.

/// Returns the comment for a text that had to be spelled in ASCII.
[[nodiscard]] std::string_view spelling_note(std::string_view text);

/// As XML or HTML content or attribute value.
[[nodiscard]] std::string xml_text(std::string_view text);

/// As the value of a DXF group: no group separator, no escape and no %% code of TEXT acts. Beyond
/// ASCII as \U+XXXX, in UTF-16.
[[nodiscard]] std::string dxf_text(std::string_view text);

/// Within the apostrophes of a string of ISO 10303-21: they and the backslash doubled, beyond ASCII
/// as \X2\ (UTF-16) or \X4\.
[[nodiscard]] std::string step_text(std::string_view text);

/// For a comment of RS-274, but not as its first word, because (MSG, (PRINT, (LOGOPEN, and others
/// act there. Keeps letters, digits and "+-_.,:=/# "; other characters become '_'. With its
/// spelling_note.
[[nodiscard]] std::string gcode_text(std::string_view text);

/// In a comment or a header line of DSTV, never empty ('-'): a reader may skip blank lines. Kept as
/// in gcode_text.
[[nodiscard]] std::string dstv_text(std::string_view text);

/// For a comment (* *) of IEC 61131-3: no character ends the comment, opens one inside it or begins
/// a pragma. Kept and spelled as in gcode_text.
[[nodiscard]] std::string structured_text_text(std::string_view text);

/// For a whole cell of CSV: quoted if necessary (RFC 4180), with a `'` before each of = + - @ '
/// that begins it, or follows a `,`, `;` or `|` in it, so that no spreadsheet, with any separator,
/// computes it. Removing those gives the text. Not for numbers.
[[nodiscard]] std::string csv_text(std::string_view text);

}  // namespace tubecut::api
