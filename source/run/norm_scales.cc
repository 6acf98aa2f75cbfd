#include "run/norm_scales.h"
#include "parallel/largest.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// What is resolved to 1e-8: lengths relative to displacements, forces relative to stiffness times the displacement
    /// of the increment, 1e-13, and times the whole displacement or the size of a cell, 20 times the round-off of a
    /// number.
    constexpr double resolved_length = 1e-6, resolved_force = 1e-5, resolved_total_force = 2e-7;
  } // namespace

  NormScales::NormScales(const Model &model, const Vector &u, const Vector &start, const double stiffness)
  {
    Vector moved(u);
    moved -= start;
    const double all = largest_entry(u);
    length           = std::max({largest_entry(moved), model.length_scale, resolved_length * all});
    noise            = resolved_total_force * stiffness * std::max(all, model.stiffest_cell);
    force            = std::max(noise, resolved_force * stiffness * length);
  }
} // namespace Nodus
