#ifndef nodus_parameters_id_or_name_h
#define nodus_parameters_id_or_name_h

#include <deal.II/base/patterns.h>

#include <memory>
#include <string>
#include <vector>

namespace Nodus
{
  /// Whether @p text is a whole number that an int holds.
  bool is_id(const std::string &text);

  /// "1, 2, lid".
  std::string joined(const std::vector<unsigned int> &ids, const std::vector<std::string> &names);

  /// Whole numbers >= 0, and texts that are no numbers.
  class IdOrName : public dealii::Patterns::PatternBase
  {
  public:
    bool                         match(const std::string &text) const override;
    std::string                  description(OutputStyle = Machine) const override;
    std::unique_ptr<PatternBase> clone() const override;
  };
} // namespace Nodus

#endif
