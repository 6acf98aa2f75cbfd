#ifndef nodus_solve_condensation_h
#define nodus_solve_condensation_h

#include "solve/block_csr_rows.h"
#include "solve/constrained_matrix.h"
#include "solve/node_block.h"
#include "solve/saddle_point_operator.h"

#include <deal.II/lac/la_parallel_vector.h>

#include <Eigen/Dense>

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <vector>

namespace Nodus
{
  class ConstraintCluster;

  /// A system whose constraints do not give the displacements of the slave nodes: it needs another solver.
  class NotCondensable : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// Exact elimination of the multipliers and of the slave displacements that they hold (theory section 25, eq. D1-D3).
  ///
  /// The three multipliers of a slave node are turned until their compliance C is diagonal. Where it vanishes the row
  /// of B is a constraint b u = g, which gives the displacement of the slave node along b by that of other nodes;
  /// elsewhere m = (b u - g)/c adds the stiffness b^T b/c. So u = T y + u_g, where y are displacements, but in a basis
  /// of their own at slave nodes with constraints or stiff rows, whose jumps stand among the y; and
  ///
  ///     T^T A T y = T^T (f + B^T D g - A u_g),   A = K + C_uu + B^T D B,   D = 1/c on rows that are no constraints.
  class Condensation
  {
  public:
    /// Keeps a reference to @p system. Collective. @throws NotCondensable, on every rank
    explicit Condensation(const SaddlePointOperator &system);
    ~Condensation();

    /// y = T^T A T x.
    void vmult(Vector &y, const Vector &x) const;

    /// The condensed right-hand side that belongs to @p b; keeps u_g.
    void condense(const BlockVector &b, Vector &rhs);
    /// Displacements and multipliers @p x that belong to the solution @p y.
    void expand(const Vector &y, const BlockVector &b, BlockVector &x) const;

    /// T^T A T in the form that multigrid takes; friction enters by its part along the rows of B.
    Constraints constraints() const;

    /// Turns modes of the owned displacements, one after the other, into the unknowns y.
    void transform_modes(std::vector<double> &modes) const;

    /// What T does to each owned slave node: equal for equal constraints.
    std::vector<char> signature() const;

  private:
    using Matrix3 = Eigen::Matrix3d;
    /// A turned row of B.
    struct TurnedRow
    {
      unsigned int site, row;
    };
    struct Site
    {
      unsigned int           node;                  ///< local, owned
      Matrix3                turn;                  ///< columns: combinations of the multipliers
      Eigen::Vector3d        flexibility_inverse;   ///< 1/c of each combination, 0 for constraints
      bool                   has_spring    = false; ///< a compliant row that is not zero
      unsigned int           n_constraints = 0;     ///< the first directions of the basis
      unsigned int           n_directions  = 0;     ///< those and the stiff rows', whose unknowns are jumps
      TurnedRow              combination[3];        ///< that gives each direction
      Matrix3                basis;                 ///< columns
      double                 diagonal = 0.;         ///< mean diagonal stiffness of the node
      bool                   coupled  = false;      ///< to constraints of other slave nodes, or of several sites
      std::vector<NodeBlock> rows;                  ///< turned rows of B, the own node first
    };
    /// Row of T: u = own y + sum of block y of others.
    struct Row
    {
      Matrix3                own;
      std::vector<NodeBlock> others;
    };

    void make_sites();
    void classify(unsigned int k, const Matrix3 &C);
    bool join_sites_of_nodes();
    void complete_basis(Site &site, unsigned int n) const;
    void find_coupled_sites();
    void make_rows();
    void make_cluster();
    void fetch_ghost_rows();
    void make_transformation();
    /// Inverse of the first @p n constraint rows along the basis, in a matrix that is zero beyond.
    Matrix3 constraint_inverse(const Site &site, unsigned int n) const;

    void apply_stiffness(double *m) const; ///< m = D m
    /// D of a site, plus C_uu of its node as a stiffness of the rows of B (theory section 27).
    Matrix3 stiffness_along_rows(const Site &site) const;
    /// Rows of B T of a site.
    NodeRow transformed_rows(const Site &site) const;
    void    add_springs(const double *u, double *f) const; ///< f += B^T D B u
    void    apply_transformation(const double *y, double *u) const;
    void    apply_transposed(const double *f, double *y) const;

    const SaddlePointOperator                   &system_;
    const NodeMap                               &nodes_;
    std::vector<Site>                            sites_; ///< of the owned slave nodes; one for each node has directions
    bool                                         has_springs_ = false; ///< on any rank
    std::vector<std::unique_ptr<Row>>            rows_;                ///< by local node; null where T is the identity
    std::unique_ptr<ConstraintCluster>           cluster_;
    std::unique_ptr<const BlockCsrRows>          replaced_;   ///< K at nodes where T is not the identity
    std::vector<std::pair<unsigned int, double>> eliminated_; ///< owned unknowns without meaning, and a diagonal
    std::shared_ptr<const Transformation>        T_;
    std::vector<double>                          particular_; ///< u_g
    mutable std::vector<double>                  u_, f_, multiplier_;
  };
} // namespace Nodus

#endif
