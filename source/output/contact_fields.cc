#include <nodus/output/contact_fields.h>

namespace Nodus
{
  void ContactFields::append(const ContactFields &other, const unsigned int i)
  {
    X.push_back(other.X[i]);
    displacement.push_back(other.displacement[i]);
    pressure.push_back(other.pressure[i]);
    multiplier.push_back(other.multiplier[i]);
    gap.push_back(other.gap[i]);
    friction.push_back(other.friction[i]);
    for (unsigned int d = 0; d < 2; ++d)
    {
      shear[d].push_back(other.shear[d][i]);
      slip[d].push_back(other.slip[d][i]);
    }
    status.push_back(other.status[i]);
    normal.push_back(other.normal[i]);
    tangent1.push_back(other.tangent1[i]);
    area.push_back(other.area[i]);
    paired.push_back(other.paired[i]);
    status_changes.push_back(other.status_changes[i]);
    cycle_period.push_back(other.cycle_period[i]);
    contradiction.push_back(other.contradiction[i]);
    number.push_back(other.number[i]);
  }
} // namespace Nodus
