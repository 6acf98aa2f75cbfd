#include "output/verdict.h"

#include <sstream>

namespace Nodus
{
  void Verdict::merge(const Verdict &other)
  {
    for (unsigned int m = 0; m < n_measures; ++m)
      if (other.findings_[m].share() >= findings_[m].share())
        findings_[m] = other.findings_[m];
  }

  std::string Verdict::text(const Measure measure) const
  {
    const Finding     &finding = (*this)[measure];
    std::ostringstream text;
    text.precision(3);
    text << measure_names[static_cast<unsigned int>(measure)] << ' ' << finding.value << ", tolerance "
         << finding.tolerance;
    if (!finding.where.empty())
      text << ", " << finding.where;
    return text.str();
  }
} // namespace Nodus
