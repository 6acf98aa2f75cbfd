#ifndef nodus_solve_multigrid_transfer_h
#define nodus_solve_multigrid_transfer_h

#include "solve/constrained_matrix.h"
#include "solve/multigrid/prolongation.h"

#include <memory>
#include <vector>

namespace Nodus
{
  /// From a level of Multigrid to the next coarser one, in node blocks: x += P y, and A_coarse = P^T A P. Blocks need a
  /// ninth of the indices of a general sparse matrix, and their products fill vector registers.
  class Transfer
  {
  public:
    virtual ~Transfer() = default;

    /// P^T A P for a matrix @p A that was made of @p K. Collective.
    std::unique_ptr<BlockCsrMatrix> make_coarse_matrix(const BlockCsrMatrix &K, const ConstrainedMatrix &A) const;
    /// The modes in the owned unknowns of the coarse level, six one after the other; to be taken.
    std::vector<double> &modes()
    {
      return coarse_modes_;
    }
    /// coarse = P^T fine. Collective.
    void restrict_to(double *coarse, const double *fine) const;
    /// fine += P coarse. Collective.
    void add_prolongation(double *fine, const double *coarse) const;

    static constexpr unsigned int n_modes = Prolongation::n_modes;

  protected:
    static constexpr unsigned int block_size = Prolongation::block_size;

    explicit Transfer(const NodeMap &nodes);
    /// To be called once P_ is complete. Collective.
    void prepare_exchange();

    const MPI_Comm      communicator_;
    const unsigned int  n_nodes_; ///< owned
    Prolongation        P_;
    std::vector<double> coarse_modes_;

  private:
    /// Calls f(row) for those without columns of other ranks.
    template <typename Function>
    void for_interior_rows(const Function &f) const;

    std::vector<std::uint32_t>  interface_; ///< rows with columns of other ranks
    GhostExchange               exchange_;
    mutable std::vector<double> ghost_values_; ///< six per ghost
  };
} // namespace Nodus

#endif
