#include <nodus/contact/contact_fields.h>

#include <algorithm>

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
    node.push_back(other.node[i]);
  }

  void ContactFields::interpolate(const std::vector<std::pair<unsigned int, double>> &others,
                                  const Point                                        &X_hanging,
                                  const Vector3                                      &u,
                                  const DoFIndex                                      number_hanging,
                                  const DoFIndex                                      node_hanging)
  {
    const auto mean = [&](auto &values)
    {
      auto sum = 0. * values.front();
      for (const auto &[place, weight] : others)
        sum += weight * values[place];
      values.push_back(sum);
    };
    for (auto *const values : {&pressure, &multiplier, &gap, &shear[0], &shear[1], &slip[0], &slip[1]})
      mean(*values);
    for (auto *const values : {&friction, &normal, &tangent1})
      mean(*values);
    const auto nearest = std::max_element(
        others.begin(), others.end(), [](const auto &a, const auto &b) { return a.second < b.second; });
    const bool alone = nearest == others.end();
    status.push_back(alone ? ContactStatus::open : status[nearest->first]);
    paired.push_back(alone ? 0 : paired[nearest->first]);
    X.push_back(X_hanging);
    displacement.push_back(u);
    area.push_back(0.);
    status_changes.push_back(0);
    cycle_period.push_back(0);
    contradiction.push_back(0);
    number.push_back(number_hanging);
    node.push_back(node_hanging);
  }
} // namespace Nodus
