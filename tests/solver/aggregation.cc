// The parts of multigrid against products with the matrix itself: sum of stiffness and correction, prolongation of the
// modes, P^T A P, and the symmetry of the cycle. Prolongation and smoother are in single precision.

#include <nodus/solve/multigrid.h>

#include "model_problem.h"

#include <deal.II/base/conditional_ostream.h>

#include <cstdlib>
#include <iostream>

using namespace Nodus;

namespace
{
  /// Springs between nodes of both cubes, wherever they are owned; two nodes are taken out of the stiffness.
  std::vector<MatrixEntry> springs(const BlockLayout &layout, const double stiffness)
  {
    std::vector<MatrixEntry> entries;
    const DoFIndex           n = layout.n_u / dim;
    if (dealii::Utilities::MPI::this_mpi_process(layout.communicator) == 0)
    {
      for (DoFIndex k = 0; k < 12; ++k)
      {
        const DoFIndex a = 5 * k + n / 3, b = n - 1 - 3 * k;
        for (unsigned int c = 0; c < dim; ++c)
          for (const auto &[i, j] : {std::pair(a, a), std::pair(b, b), std::pair(a, b), std::pair(b, a)})
            entries.push_back({dim * i + c, dim * j + c, i == j ? stiffness : -stiffness});
      }
      for (const DoFIndex node : {n / 2, n / 2 + 7})
        for (unsigned int c = 0; c < dim; ++c)
          entries.push_back({dim * node + c, dim * node + c, stiffness});
    }
    return Ownership(layout.owned[0], layout.communicator).exchange(std::move(entries));
  }

  class Check
  {
  public:
    explicit Check(const ModelProblem::Options &options)
        : problem(options)
        , K(problem.system.bulk)
        , n(dim * K.map().n_owned())
        , scale(K.largest_diagonal())
        , A(K, taken_out(), springs(problem.layout, scale))
        , modes(rigid_body_modes(K, problem.node_positions))
        , out(std::cout, dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    {
    }

    void run()
    {
      const std::vector<double> x = rough(1.), Ax = apply(x);
      std::vector<double>       y(n);
      A.vmult(y.data(), x.data());
      report("product in single precision", distance(y, Ax), 1e-6);

      std::vector<std::array<double, 9>> D_inverse(K.map().n_owned(), std::array<double, 9>{});
      for (unsigned int i = 0; i < K.map().n_owned(); ++i)
        for (unsigned int c = 0; c < dim; ++c)
          D_inverse[i][4 * c] = 1. / scale;
      constexpr double   omega = 0.6;
      Aggregation        coarse(K, A, modes, D_inverse, omega);
      const auto         matrix   = coarse.make_coarse_matrix(K);
      const Epetra_Map   map      = matrix->map().dof_map();
      const unsigned int n_coarse = map.NumMyElements();

      double worst = 0.;
      for (unsigned int m = 0; m < Aggregation::n_modes; ++m)
      {
        std::vector<double> prolonged(n, 0.), wanted(modes.begin() + m * n, modes.begin() + (m + 1) * n);
        coarse.add_prolongation(prolonged.data(), coarse.modes().data() + m * n_coarse);
        const std::vector<double> product = apply(wanted);
        for (unsigned int i = 0; i < n; ++i)
          wanted[i] -= omega / scale * product[i];
        worst = std::max(worst, distance(prolonged, wanted));
      }
      report("prolonged modes are the smoothed ones", worst, 1e-6);

      std::vector<double> z(n_coarse), A_z(n_coarse), product(n_coarse);
      for (unsigned int i = 0; i < n_coarse; ++i)
        z[i] = std::cos(3. * (map.GID(i) + 1));
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
      report("coarse matrix is P^T A P", std::sqrt(difference / norm), 1e-12);

      const Multigrid multigrid(K, A, modes, 2);
      Vector          u, v, Mu, Mv;
      for (Vector *w : {&u, &v, &Mu, &Mv})
        w->reinit(problem.layout.owned[0], MPI_COMM_WORLD);
      std::copy_n(rough(1.).begin(), n, u.trilinos_vector()[0]);
      std::copy_n(rough(7.).begin(), n, v.trilinos_vector()[0]);
      multigrid.vmult(Mu, u);
      multigrid.vmult(Mv, v);
      report("cycle is symmetric", std::abs(u * Mv - v * Mu) / std::sqrt((u * Mu) * (v * Mv)), 1e-6);
      out << "cycle is positive: " << yes(u * Mu > 0. && v * Mv > 0.) << std::endl;
    }

  private:
    static const char *yes(const bool condition)
    {
      return condition ? "yes" : "NO";
    }
    std::vector<char> taken_out() const
    {
      std::vector<char> flags(K.map().size(), 0);
      const DoFIndex    middle = problem.layout.n_u / dim / 2;
      for (unsigned int i = 0; i < flags.size(); ++i)
        flags[i] = K.map().global(i) == middle || K.map().global(i) == middle + 7;
      return flags;
    }
    std::vector<double> rough(const double seed) const
    {
      std::vector<double> x(n);
      for (unsigned int i = 0; i < n; ++i)
        x[i] = std::sin(seed * (dim * K.map().global(i / dim) + i % dim + 1.));
      return x;
    }
    /// A x in double precision, block by block.
    std::vector<double> apply(const std::vector<double> &x) const
    {
      const NodeValues    all = A.map().with_ghosts(x.data());
      std::vector<double> y(n, 0.);
      for (unsigned int i = 0; i < K.map().n_owned(); ++i)
        A.for_row(K,
                  i,
                  [&](const unsigned int j, const double *block, const bool transposed)
                  {
                    for (unsigned int c = 0; c < dim; ++c)
                      for (unsigned int d = 0; d < dim; ++d)
                        y[dim * i + c] += block[transposed ? dim * d + c : dim * c + d] * all[j][d];
                  });
      return y;
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
    const NodeMatrix          &K;
    const unsigned int         n;
    const double               scale; ///< of the stiffness
    const CorrectedMatrix      A;
    const std::vector<double>  modes;
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
