#ifndef nodus_base_types_h
#define nodus_base_types_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <stdexcept>
#include <string>

namespace dealii
{
  namespace MemorySpace
  {
    struct Host;
  }
  namespace LinearAlgebra
  {
    namespace distributed
    {
      template <typename Number, typename MemorySpace>
      class Vector;
#if DEAL_II_VERSION_GTE(9, 7, 0)
      template <typename Number, typename MemorySpace>
#else
      template <typename Number>
#endif
      class BlockVector;
    } // namespace distributed
  }   // namespace LinearAlgebra
} // namespace dealii

/// Frictional contact of 3D finite-strain bodies.
///
/// Signs, everywhere: n points from slave to master, jumps are slave minus master, d_n > 0 is
/// penetration, the contact pressure multiplier lambda is <= 0 in compression.
namespace Nodus
{
  constexpr unsigned int dim = 3;

  using Vector = dealii::LinearAlgebra::distributed::Vector<double, dealii::MemorySpace::Host>;
#if DEAL_II_VERSION_GTE(9, 7, 0)
  using BlockVector = dealii::LinearAlgebra::distributed::BlockVector<double, dealii::MemorySpace::Host>;
#else
  using BlockVector = dealii::LinearAlgebra::distributed::BlockVector<double>;
#endif
  using DoFIndex = dealii::types::global_dof_index;
  using Point    = dealii::Point<dim>;
  using Vector3  = dealii::Tensor<1, dim>;

  /// Status of a slave node; stick and slip are both "contact" (S = 1).
  enum class ContactStatus : unsigned char
  {
    open,
    slip,
    stick
  };

  /// Something in the input is wrong: the message names file, key and fix. Exit code 1.
  class InputError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// A Newton, a loop or a linear solver did not succeed. Thrown on every rank alike.
  class SolverFailure : public std::runtime_error
  {
  public:
    enum class Kind
    {
      unspecified,
      newton_limit,    ///< not converged in the iterations that Newton may take
      newton_stalled,  ///< a merged iteration without progress
      newton_lost,     ///< likewise, and no iterate came near balance: the increment is too large for it
      not_finite,      ///< residual, matrix or solution
      inverted_cell,   ///< det F <= 0
      free_body,       ///< singular system: nothing resists a displacement
      over_constraint, ///< singular system: a constraint repeats another one
      linear_solver,   ///< the solution of a linear system did not succeed
      status_cycle,
      geometry_cycle,
      loop_limit,         ///< not converged in the passes that a loop may take
      judged,             ///< what the loops found does not hold where it is measured anew
      prescribed_contact, ///< likewise, because displacements of both sides are prescribed: no smaller increment helps
      before_interval,    ///< under arc length time goes back below the begin of the interval
      beyond_interval     ///< likewise, beyond its end
    };

    explicit SolverFailure(const std::string &message, const Kind kind = Kind::unspecified)
        : std::runtime_error(message)
        , kind_(kind)
    {
    }
    Kind kind() const
    {
      return kind_;
    }

  private:
    Kind kind_;
  };
} // namespace Nodus

#endif
