#ifndef nodus_solve_constrained_matrix_h
#define nodus_solve_constrained_matrix_h

#include "solve/block_csr_matrix.h"
#include "solve/transformation.h"

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace Nodus
{
  /// What contact makes of a stiffness K: T^T K T + R^T D R + d.
  struct Constraints
  {
    struct Spring
    {
      NodeRow               row; ///< three rows of R
      std::array<double, 9> D;   ///< symmetric
    };
    std::shared_ptr<const Transformation>        T;        ///< with rows of the ghosts of K; null: the identity
    std::vector<Spring>                          springs;  ///< each on one rank
    std::vector<std::pair<unsigned int, double>> diagonal; ///< d: owned displacements that vanish in T and in R
  };

  /// A = T^T K T + R^T D R + d for multigrid, in these factors: T and R couple a slave node with some ten others, A
  /// couples each of those with a hundred. Products use a copy of K in single precision: half the memory traffic.
  class ConstrainedMatrix
  {
  public:
    /// K alone.
    explicit ConstrainedMatrix(const BlockCsrMatrix &K);
    /// Collective.
    ConstrainedMatrix(const BlockCsrMatrix &K, Constraints constraints);

    /// Local numbers of the nodes: those of K, then ghosts that T and R reach.
    const NodeMap &map() const
    {
      return *nodes_;
    }
    /// y = A x over the owned degrees of freedom; meanwhile @p x is T x. Collective.
    void vmult(double *y, double *x) const;

    /// Diagonal blocks of A for the K of the constructor, row by row. Collective.
    std::vector<std::array<double, 9>> diagonal_blocks(const BlockCsrMatrix &K) const;

    /// Whether there is more than K; the same on all ranks.
    bool constrained() const
    {
      return R_ != nullptr;
    }
    /// Rows of T and of R with local nodes.
    using LocalRow = std::vector<std::pair<unsigned int, std::array<double, 9>>>;
    struct LocalSpring
    {
      LocalRow              row;
      std::array<double, 9> D;
    };
    /// Of a local node of K; null where T is the identity.
    const LocalRow *replacement(const unsigned int node) const
    {
      return replacement_.empty() || replacement_[node] == none ? nullptr : &T_rows_[replacement_[node]].second;
    }
    /// Local nodes that T replaces, ascending, and their rows.
    const std::vector<std::pair<unsigned int, LocalRow>> &replacements() const
    {
      return T_rows_;
    }
    const std::vector<LocalSpring> &springs() const
    {
      return springs_;
    }

  private:
    static constexpr unsigned int none = static_cast<unsigned int>(-1);

    LocalRow to_local(const NodeRow &row) const;

    const Constraints                              constraints_;
    const std::shared_ptr<const NodeMap>           K_nodes_;
    const std::shared_ptr<const NodeMap>           nodes_;
    const std::shared_ptr<const NodePattern>       pattern_;
    const std::vector<float>                       stiffness_;
    std::vector<unsigned int>                      replacement_; ///< by local node of K: index into T_rows_, or none
    std::vector<std::pair<unsigned int, LocalRow>> T_rows_;
    std::vector<LocalSpring>                       springs_;
    std::unique_ptr<const CouplingMatrix>          R_; ///< null without constraints
    mutable std::vector<double>                    forces_;
  };
} // namespace Nodus

#endif
