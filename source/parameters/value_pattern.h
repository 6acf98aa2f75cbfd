#ifndef nodus_parameters_value_pattern_h
#define nodus_parameters_value_pattern_h

#include <limits>
#include <string>
#include <vector>

namespace Nodus
{
  /// What a key takes, read from the description that a pattern of deal.II gives of itself, such as
  /// "[List of <[Double 0...MAX_DOUBLE (inclusive)]> of length 3...3 (inclusive) separated by <,>]".
  struct ValuePattern
  {
    enum class Kind
    {
      text,
      file, ///< the name of one
      truth,
      whole_number,
      number,
      id_or_name, ///< a whole number >= 0, or a text that is no number
      choice,
      list
    };

    explicit ValuePattern(const std::string &description);

    Kind                      kind = Kind::text;
    std::string               least, most;  ///< bounds of a number as texts, empty without
    bool                      open = false; ///< whether a number is larger than `least`
    std::vector<std::string>  choices;
    std::vector<ValuePattern> entries; ///< of a list: what each of them takes
    unsigned int              shortest = 0, longest = std::numeric_limits<unsigned int>::max(); ///< lengths of a list
    char                      separator = '\0';                                                 ///< of a list

    /// "a number >= 0", "one of: direct, block"
    std::string in_words() const;

    /// {"kind": "number", "least": 0}, as `nodus --document-json` prints it.
    std::string in_json() const;
  };

  /// A JSON text, in quotes.
  std::string json_text(const std::string &text);
} // namespace Nodus

#endif
