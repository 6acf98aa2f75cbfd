// The parts of multigrid against products with T^T K T + R^T D R + d from global vectors: prolongation of the modes,
// P^T A P, and the symmetry of the cycle; of degree 2 with degree 1 below it as well. Prolongation and smoother are in
// single precision. Also that matrix entry by entry, as other libraries get it.

#include "solve/multigrid/aggregation.h"
#include "solve/multigrid/corner_transfer.h"
#include "solve/multigrid/multigrid.h"
#include "solve/trilinos/assemble.h"

#include "model_problem.h"

#include <deal.II/base/conditional_ostream.h>

#include <cstdlib>
#include <iostream>

using namespace Nodus;

namespace
{
  using Block = std::array<double, 9>;

  Block diagonal(const double x, const double y, const double z)
  {
    return {{x, 0., 0., 0., y, 0., 0., 0., z}};
  }

  /// Nodes of one cube are replaced by such of the other, in one direction or in all, and springs connect the cubes,
  /// wherever those nodes are owned. All of it on every rank.
  struct GlobalConstraints
  {
    std::vector<std::pair<DoFIndex, NodeRow>> replaced;
    std::vector<Constraints::Spring>          springs;
    std::vector<std::pair<DoFIndex, double>>  diagonal;

    GlobalConstraints(const DoFIndex n, const double stiffness)
    {
      for (DoFIndex k = 0; k < 8; ++k)
      {
        const DoFIndex z = 2 * k + n / 3, other = n - 1 - 3 * k;
        replaced.emplace_back(z,
                              NodeRow{{z, k % 2 == 0 ? Block{{0., 0.6, 0., 0., 0.8, 0., 0., 0., 1.}} : Block{}},
                                      {other, Block{{0.5, 0.1, 0., -0.2, 0.7, 0., 0., 0., 0.4}}},
                                      {other - 1, ::diagonal(0.5, 0.3, 0.6)}});
        for (unsigned int c = 0; c < (k % 2 == 0 ? 1U : 3U); ++c)
          diagonal.emplace_back(dim * z + c, stiffness);
      }
      for (DoFIndex k = 0; k < 12; ++k)
        springs.push_back({{{5 * k + n / 3 + 20, ::diagonal(1., 1., 1.)},
                            {n - 2 - 3 * k, ::diagonal(-1., -0.5, -1.)},
                            {n / 3 + 3, Block{{0., 0.1, 0., 0., 0., 0.1, 0., 0., 0.}}}},
                           Block{{stiffness, 0., 0.1 * stiffness, 0., 2. * stiffness, 0., 0.1 * stiffness, 0., 0.}}});
    }
    Constraints on_rank(const BlockCsrMatrix &K, const Ownership &displacements) const
    {
      Constraints                                   result;
      std::vector<std::pair<unsigned int, NodeRow>> rows;
      unsigned int                                  n_owned = 0;
      for (unsigned int i = 0; i < K.map().size(); ++i)
        for (const auto &[node, row] : replaced)
          if (node == K.map().global(i))
          {
            rows.emplace_back(i, row);
            n_owned += i < K.map().n_owned();
          }
      result.T = std::make_shared<const Transformation>(std::move(rows), n_owned, displacements);
      if (dealii::Utilities::MPI::this_mpi_process(K.map().communicator()) == 0)
        result.springs = springs;
      for (const auto &[dof, value] : diagonal)
        if (dof >= displacements.begin() && dof < displacements.end())
          result.diagonal.emplace_back(dof - displacements.begin(), value);
      return result;
    }
  };

  class Check
  {
  public:
    explicit Check(const ModelProblem::Options &options)
        : problem(options)
        , K(problem.system.bulk)
        , n(dim * K.map().n_owned())
        , scale(K.largest_diagonal())
        , constraints(K.map().n_global(), scale)
        , displacements(n, MPI_COMM_WORLD)
        , A(K, constraints.on_rank(K, displacements))
        , modes(rigid_body_modes(K, problem.node_positions))
        , out(std::cout, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    {
    }

    void run()
    {
      for (const auto &[dof, value] : constraints.diagonal) // as condensation does it
        if (dof >= displacements.begin() && dof < displacements.end())
          for (unsigned int m = 0; m < Aggregation::n_modes; ++m)
            modes[m * n + dof - displacements.begin()] = 0.;
      const std::vector<double> before = rough(1.), Ax = apply(before);
      std::vector<double>       x = before, y(n);
      A.vmult(y.data(), x.data());
      report("product in single precision", distance(y, Ax), 1e-6);
      report("the argument is what it was", distance(x, before), 0.);

      check_assembled(before, Ax);

      const std::vector<std::array<double, 9>> blocks      = A.diagonal_blocks(K);
      double                                   worst_block = 0.;
      for (const DoFIndex node : tried_nodes())
        for (unsigned int c = 0; c < dim; ++c)
        {
          const bool          here = dim * node >= displacements.begin() && dim * node < displacements.end();
          const unsigned int  i    = dim * node - displacements.begin();
          std::vector<double> unit(n, 0.);
          if (here)
            unit[i + c] = 1.;
          const std::vector<double> column = apply(unit);
          for (unsigned int d = 0; d < dim && here; ++d)
            worst_block = std::max(worst_block, std::abs(column[i + d] - blocks[i / dim][dim * d + c]) / scale);
        }
      report("diagonal blocks", dealii::Utilities::MPI::max(worst_block, MPI_COMM_WORLD), 1e-12);

      std::vector<std::array<double, 9>> D_inverse(K.map().n_owned(), std::array<double, 9>{});
      for (unsigned int i = 0; i < K.map().n_owned(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          D_inverse[i][4 * c] = 1. / scale;
      constexpr double omega = 0.6;
      Aggregation      aggregates(K, A, modes, D_inverse, omega);
      check_transfer("aggregates", aggregates, omega / scale);
      check_cycle(problem.node_positions);
      if (problem.corners.pairs.empty())
        return;
      CornerTransfer corners(A, modes, problem.nodes());
      check_transfer("corners", corners, 0.);
      check_cycle(problem.nodes());
    }

  private:
    /// @param damping of P = (1 - damping A) P_0
    void check_transfer(const std::string &name, Transfer &coarse, const double damping)
    {
      const auto         matrix   = coarse.make_coarse_matrix(K, A);
      const unsigned int n_coarse = dim * matrix->map().n_owned();

      double worst = 0.;
      for (unsigned int m = 0; m < Transfer::n_modes; ++m)
      {
        std::vector<double> prolonged(n, 0.), wanted(modes.begin() + m * n, modes.begin() + (m + 1) * n);
        coarse.add_prolongation(prolonged.data(), coarse.modes().data() + m * n_coarse);
        const std::vector<double> product = apply(wanted);
        for (unsigned int i = 0; i < n; ++i)
          wanted[i] -= damping * product[i];
        worst = std::max(worst, distance(prolonged, wanted));
      }
      report(name + ": prolonged modes are the smoothed ones", worst, 1e-6);

      std::vector<double> z(n_coarse), A_z(n_coarse), product(n_coarse);
      for (unsigned int i = 0; i < n_coarse; ++i)
        z[i] = std::cos(3. * (dim * matrix->map().global(i / dim) + i % dim + 1));
      std::vector<double> fine(n, 0.);
      coarse.add_prolongation(fine.data(), z.data());
      coarse.restrict_to(product.data(), apply(fine).data());
      matrix->vmult(A_z.data(), z.data());
      // unknowns of aggregates that are too small for six modes have a diagonal of their own
      double difference = 0., norm = 0.;
      for (unsigned int i = 0; i < n_coarse; ++i)
        if (product[i] != 0.)
        {
          difference += std::pow(product[i] - A_z[i], 2);
          norm += std::pow(product[i], 2);
        }
      difference = dealii::Utilities::MPI::sum(difference, MPI_COMM_WORLD);
      norm       = dealii::Utilities::MPI::sum(norm, MPI_COMM_WORLD);
      report(name + ": coarse matrix is P^T A P", std::sqrt(difference / norm), 1e-12);
    }

    void check_cycle(const DisplacementNodes &nodes)
    {
      const Multigrid multigrid(K, A, modes, nodes, 2);
      Vector          u, v, Mu, Mv;
      for (Vector *w : {&u, &v, &Mu, &Mv})
        w->reinit(problem.layout.owned[0], MPI_COMM_WORLD);
      std::copy_n(rough(1.).begin(), n, u.begin());
      std::copy_n(rough(7.).begin(), n, v.begin());
      multigrid.vmult(Mu, u);
      multigrid.vmult(Mv, v);
      report("cycle is symmetric", std::abs(u * Mv - v * Mu) / std::sqrt((u * Mu) * (v * Mv)), 1e-6);
      out << "cycle is positive: " << yes(u * Mu > 0. && v * Mv > 0.) << std::endl;
    }

    void check_assembled(const std::vector<double> &x, const std::vector<double> &Ax)
    {
      const AssembledMatrix     assembled = assemble(K, constraints.on_rank(K, displacements));
      const std::vector<double> all       = everywhere(x);
      std::vector<double>       y(n, 0.);
      bool                      ascending = true, alone = true;
      for (unsigned int i = 0; i < n; ++i)
        for (std::size_t k = assembled.start[i]; k < assembled.start[i + 1]; ++k)
        {
          y[i] += assembled.value[k] * all[assembled.unknowns[assembled.column[k]]];
          ascending = ascending && (k == assembled.start[i] || assembled.column[k - 1] < assembled.column[k]);
        }
      report("assembled entry by entry", distance(y, Ax), 1e-14);
      for (const auto &[dof, value] : constraints.diagonal)
        if (dof >= displacements.begin() && dof < displacements.end())
          alone = alone &&
                  assembled.start[dof - displacements.begin() + 1] == assembled.start[dof - displacements.begin()] + 1;
      const std::vector<DoFIndex> reached = tried_nodes(); // by T and R
      for (unsigned int i = 0; i < n; ++i)
        if (K.decoupled(i) && std::find(reached.begin(), reached.end(), K.map().global(i / dim)) == reached.end())
          alone = alone && assembled.start[i + 1] == assembled.start[i] + 1;
      const bool everywhere_so = dealii::Utilities::MPI::min(ascending && alone ? 1 : 0, MPI_COMM_WORLD) == 1;
      out << "columns ascend, and what is held has its diagonal alone: " << yes(everywhere_so) << std::endl;
    }

    static const char *yes(const bool condition)
    {
      return condition ? "yes" : "NO";
    }
    std::vector<DoFIndex> tried_nodes() const
    {
      std::vector<DoFIndex> nodes = {0, K.map().n_global() / 2};
      for (const auto &[node, row] : constraints.replaced)
        for (const auto &[other, block] : row)
          nodes.push_back(other);
      for (const auto &spring : constraints.springs)
        for (const auto &[other, block] : spring.row)
          nodes.push_back(other);
      return nodes;
    }
    std::vector<double> rough(const double seed) const
    {
      std::vector<double> x(n);
      for (unsigned int i = 0; i < n; ++i)
        x[i] = std::sin(seed * (dim * K.map().global(i / dim) + i % dim + 1.));
      return x;
    }
    static void multiply(const NodeRow &row, const std::vector<double> &x, double *const y)
    {
      for (const auto &[node, block] : row)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            y[c] += block[dim * c + d] * x[dim * node + d];
    }
    static void multiply_transposed(const NodeRow &row, const double *const x, std::vector<double> &y)
    {
      for (const auto &[node, block] : row)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            y[dim * node + d] += block[dim * c + d] * x[c];
    }
    /// The owned values in a vector of all, or the other way round.
    std::vector<double> everywhere(const std::vector<double> &owned) const
    {
      std::vector<double> all(displacements.start().back(), 0.);
      std::copy(owned.begin(), owned.end(), all.begin() + displacements.begin());
      dealii::Utilities::MPI::sum(all, MPI_COMM_WORLD, all);
      return all;
    }
    std::vector<double> here(const std::vector<double> &all) const
    {
      return std::vector<double>(all.begin() + displacements.begin(), all.begin() + displacements.end());
    }
    /// A x in double precision.
    std::vector<double> apply(const std::vector<double> &owned) const
    {
      const std::vector<double> x = everywhere(owned);
      std::vector<double>       u = x;
      for (const auto &[z, row] : constraints.replaced)
      {
        std::fill_n(&u[dim * z], dim, 0.);
        multiply(row, x, &u[dim * z]);
      }
      std::vector<double> f(n);
      K.vmult(f.data(), here(u).data());
      std::vector<double> forces = everywhere(f), y = forces;
      for (const auto &[z, row] : constraints.replaced)
        std::fill_n(&y[dim * z], dim, 0.);
      for (const auto &[z, row] : constraints.replaced)
        multiply_transposed(row, &forces[dim * z], y);
      for (const auto &[row, D] : constraints.springs)
      {
        double length[dim] = {}, force[dim] = {};
        multiply(row, x, length);
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            force[c] += D[dim * c + d] * length[d];
        multiply_transposed(row, force, y);
      }
      for (const auto &[dof, value] : constraints.diagonal)
        y[dof] = value * x[dof];
      return here(y);
    }
    double distance(const std::vector<double> &a, const std::vector<double> &b) const
    {
      double difference = 0., norm = 0.;
      for (unsigned int i = 0; i < n; ++i)
      {
        difference += std::pow(a[i] - b[i], 2);
        norm += std::pow(b[i], 2);
      }
      return std::sqrt(dealii::Utilities::MPI::sum(difference, MPI_COMM_WORLD) /
                       dealii::Utilities::MPI::sum(norm, MPI_COMM_WORLD));
    }
    void report(const std::string &title, const double deviation, const double tolerance)
    {
      if (std::getenv("NODUS_TEST_LOG"))
        out << "    deviation " << deviation << std::endl;
      out << title << ": " << yes(deviation <= tolerance) << std::endl;
    }

    ModelProblem::TwoCubes     problem;
    const BlockCsrMatrix      &K;
    const unsigned int         n;
    const double               scale; ///< of the stiffness
    const GlobalConstraints    constraints;
    const Ownership            displacements;
    const ConstrainedMatrix    A;
    std::vector<double>        modes;
    dealii::ConditionalOStream out;
  };
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  for (const unsigned int degree : {1, 2})
  {
    ModelProblem::Options options;
    options.n_cells = 6 / degree;
    options.degree  = degree;
    Check(options).run();
  }
}
