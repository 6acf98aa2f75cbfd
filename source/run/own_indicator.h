#ifndef nodus_run_own_indicator_h
#define nodus_run_own_indicator_h

#include "mesh/refinement.h"
#include "run/model.h"
#include <nodus/plugins/error_indicator.h>

namespace Nodus
{
  /// What an indicator that a plug-in or a program brings says about the owned cells. @p u with ghosts; @p pressure:
  /// the largest contact pressure by active cell index. The squares of its errors stand for themselves: the norm is 1.
  /// Collective. @throws InputError on every rank where it throws, or gives something that is not >= 0.
  void set_own_error(const Chosen<ErrorIndicator> &own,
                     const Model                  &model,
                     const Vector                 &u,
                     const std::vector<double>    &pressure,
                     RefinementIndicator          &indicator);
} // namespace Nodus

#endif
