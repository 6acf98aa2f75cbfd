#ifndef nodus_bulk_condition_value_h
#define nodus_bulk_condition_value_h

#include <nodus/parameters/parameters.h>

#include <deal.II/base/function.h>

#include <memory>
#include <string>

namespace Nodus
{
  /// What a condition prescribes: the expressions of its value, what a program gives instead, or a rigid motion.
  /// @throws InputError, named by @p label, where their number does not fit or one cannot be evaluated.
  std::unique_ptr<dealii::Function<dim>> make_condition_value(const BoundaryConditionParameters &parameters,
                                                              const std::string                 &label);
} // namespace Nodus

#endif
