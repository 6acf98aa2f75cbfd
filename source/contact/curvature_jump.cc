#include "contact/curvature_jump.h"

#include "contact/surface_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace Nodus
{
  namespace
  {
    using Tilt =
        dealii::Tensor<1, 2>; ///< of a normal against the average, in the directions in which they are compared

    /// The average is off by less than this part of the angles that it is over where curvature changes smoothly, ...
    constexpr double smooth = 0.2;
    /// ... and by this part and more where it jumps.
    constexpr double jump = 0.5;
    /// Angles that the average is off by less do not count, and fully from the second one on: coordinates of mesh files
    /// are rounded.
    constexpr double rounded = 1e-3, seen_angle = 2e-3;
    /// Shares that leave this part of what the average is off, or more, are not taken.
    constexpr double largest_rest = 0.3;
    /// Least share, so that a face that an edge sets apart from all others still has a normal.
    constexpr double least_share = 1e-6;

    /// Two directions normal to @p normal and to each other; on the rim one along it, the other one zero.
    std::array<Vector3, 2> directions(const Vector3 &normal, const Vector3 &rim)
    {
      Vector3 axis = rim;
      if (rim == Vector3())
        axis[std::abs(normal[0]) < 0.7 ? 0 : 1] = 1.;
      Vector3 first = axis - (axis * normal) * normal;
      first /= std::max(first.norm(), 1e-12 * axis.norm());
      return {{first, rim == Vector3() ? dealii::cross_product_3d(normal, first) : Vector3()}};
    }

    /// Geometric median of what the faces see and of the average (0), which counts for half of them, by Weiszfeld's
    /// iteration: where the curvature jumps both sides see the same, inside of a smooth part one of them sees the
    /// average. Distances below a millionth of @p scale are not told apart.
    Tilt median(const std::vector<Tilt> &seen, const double scale)
    {
      const auto pull = [&](const Tilt &distance)
      { return 1. / std::sqrt(distance.norm_square() + 1e-12 * scale * scale); };
      Tilt result;
      for (const Tilt &tilt : seen)
        result += tilt / (1.5 * seen.size());
      for (unsigned int iteration = 0; iteration < 100; ++iteration)
      {
        double pulls = 0.5 * seen.size() * pull(result);
        Tilt   sum;
        for (const Tilt &tilt : seen)
        {
          const double strength = pull(tilt - result);
          pulls += strength;
          sum += strength * tilt;
        }
        result = sum / pulls;
      }
      return result;
    }

    /// Parts >= 0 of sum one, near to those given, of tilts that add up to @p target or to what is nearest to it: parts
    /// go from one tilt to another until nothing is gained.
    std::vector<double>
    combination(const std::vector<Tilt> &tilts, const Tilt &target, const std::vector<double> &given)
    {
      std::vector<double> parts = given;
      Tilt                rest  = -target;
      double              hold  = 0.;
      for (unsigned int a = 0; a < tilts.size(); ++a)
      {
        rest += parts[a] * tilts[a];
        hold += 1e-6 * tilts[a].norm_square();
      }
      double largest_step = 1.;
      for (unsigned int sweep = 0; sweep < 200 && largest_step > 1e-9; ++sweep)
      {
        largest_step = 0.;
        for (unsigned int a = 0; a < tilts.size(); ++a)
          for (unsigned int b = 0; b < a; ++b)
          {
            const Tilt   apart = tilts[a] - tilts[b];
            const double gain  = rest * apart + hold * (parts[a] - given[a] - parts[b] + given[b]);
            const double step  = std::clamp(-gain / (apart.norm_square() + 2. * hold), -parts[a], parts[b]);
            parts[a] += step;
            parts[b] -= step;
            rest += step * apart;
            largest_step = std::max(largest_step, std::abs(step));
          }
      }
      return parts;
    }

    /// Mean of what the faces see; the less a face turns, the more it is right.
    Tilt of_flattest(const std::vector<Tilt> &seen, const std::vector<double> &turns, const double scale)
    {
      Tilt   sum;
      double weights = 0.;
      for (unsigned int f = 0; f < seen.size(); ++f)
      {
        const double weight = 1. / (turns[f] * turns[f] + 1e-6 * scale * scale);
        sum += weight * seen[f];
        weights += weight;
      }
      return sum / weights;
    }

    /// What the average should be, which is 0 itself: something else where the curvature jumps.
    Tilt target(const std::vector<Tilt> &tilts, const std::vector<Tilt> &seen, const std::vector<double> &turns)
    {
      double largest = 0., along = 0.;
      for (const Tilt &tilt : tilts)
        largest = std::max(largest, tilt.norm());
      if (seen.size() < 2 || largest < rounded)
        return Tilt();
      const Tilt   found  = median(seen, largest);
      const double length = found.norm();
      if (length < rounded)
        return Tilt();
      for (const Tilt &tilt : tilts)
        along = std::max(along, std::abs(tilt * found) / length);
      const double part = Fading(length / std::max(along, smooth * largest), jump, smooth).part *
                          Fading(length, seen_angle, rounded).part;
      const Tilt better = of_flattest(seen, turns, largest);
      return part * ((better - found).norm() < 0.5 * length ? better : found);
    }

    /// Share of faces[own] as it sees those around.
    double normal_share(const std::vector<FaceAtNode> &faces, const unsigned int own, const Vector3 &rim)
    {
      const auto along = directions(averaged_normal(faces, faces[own].normal), rim);
      const auto tilt  = [&](const Vector3 &v)
      {
        Tilt result;
        result[0] = v * along[0];
        result[1] = v * along[1];
        return result;
      };
      const bool any_inside =
          std::any_of(faces.begin(), faces.end(), [](const FaceAtNode &face) { return face.inside; });

      std::vector<double> parts, turns;
      std::vector<Tilt>   tilts, seen;
      unsigned int        self = 0;
      double              sum  = 0.;
      for (unsigned int f = 0; f < faces.size(); ++f)
      {
        const double part = belongs_to_surface(faces[f].normal, faces[own].normal).part;
        if (part == 0.)
          continue;
        if (f == own)
          self = parts.size();
        parts.push_back(part * faces[f].weight);
        sum += parts.back();
        tilts.push_back(tilt(faces[f].normal));
        if (faces[f].seen != Vector3() && (faces[f].inside || !any_inside))
        {
          seen.push_back(tilt(faces[f].seen));
          turns.push_back(faces[f].turn);
        }
      }
      const Tilt wanted = target(tilts, seen, turns);
      if (wanted == Tilt())
        return 1.;
      for (double &part : parts)
        part /= sum;
      const std::vector<double> better  = combination(tilts, wanted, parts);
      Tilt                      rest    = -wanted;
      double                    largest = 0.;
      for (unsigned int f = 0; f < parts.size(); ++f)
      {
        rest += better[f] * tilts[f];
        largest = std::max(largest, better[f] / parts[f]);
      }
      return rest.norm() >= largest_rest * wanted.norm() ? 1.
                                                         : std::max(better[self] / parts[self] / largest, least_share);
    }
  } // namespace

  Vector3 averaged_normal(const std::vector<FaceAtNode> &faces, const Vector3 &own)
  {
    Vector3 sum;
    for (const FaceAtNode &face : faces)
      sum += belongs_to_surface(face.normal, own).part * face.weight * face.normal;
    return sum / sum.norm();
  }

  std::vector<double> normal_shares(const std::vector<FaceAtNode> &faces, const Vector3 &rim)
  {
    std::vector<double> shares;
    for (unsigned int f = 0; f < faces.size(); ++f)
      shares.push_back(normal_share(faces, f, rim));
    return shares;
  }
} // namespace Nodus
