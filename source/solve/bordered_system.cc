#include "solve/bordered_system.h"
#include "parallel/ownership.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <utility>

namespace Nodus
{
  BorderedSystem::BorderedSystem(const LinearSystem &system)
      : system_(system)
      , B_(2 * dim * system.layout->n_rigid)
      , C_(B_.size())
  {
    const BlockLayout &layout = *system.layout;
    for (std::vector<BlockVector> *const vectors : {&B_, &C_})
      for (BlockVector &v : *vectors)
        layout.reinit(v);
    std::array<std::vector<MatrixEntry>, 3> entries; // of the blocks: their row, and the column of B, then of C^T
    const auto                              add = [&](const DoFIndex flat, const DoFIndex column, const double value)
    {
      const DoFIndex multiplier = flat - std::min(flat, layout.n_u);
      if (flat < layout.n_u)
        entries[0].push_back({flat, column, value});
      else if (multiplier < layout.n_slave_nodes)
        entries[1].push_back({multiplier, column, value});
      else
        entries[2].push_back({multiplier - layout.n_slave_nodes, column, value});
    };
    std::vector<double>  D(B_.size() * B_.size(), 0.);
    const TripletMatrix &border = system.border;
    for (std::size_t k = 0; k < border.value.size(); ++k)
      if (border.row[k] < layout.size())
        add(border.row[k], border.column[k] - layout.size(), border.value[k]);
      else if (border.column[k] < layout.size())
        add(border.column[k], B_.size() + border.row[k] - layout.size(), border.value[k]);
      else
        D[(border.row[k] - layout.size()) * B_.size() + border.column[k] - layout.size()] += border.value[k];
    for (unsigned int block = 0; block < 3; ++block)
      for (const MatrixEntry &e :
           Ownership(layout.owned[block], layout.communicator).exchange(std::move(entries[block])))
        (e.column < B_.size() ? B_[e.column] : C_[e.column - B_.size()]).block(block)(e.row) = e.value;
    dealii::Utilities::MPI::sum(D, layout.communicator, D);
    D_ = dealii::FullMatrix<double>(B_.size(), B_.size(), D.data());
  }

  void BorderedSystem::eliminate(const Solve                      &solve,
                                 const dealii::FullMatrix<double> &P,
                                 const dealii::Vector<double>     &p,
                                 const std::vector<unsigned int>  &rows,
                                 const dealii::Vector<double>     &b)
  {
    const unsigned int       n = P.n();
    std::vector<BlockVector> rhs(n + 1);
    for (unsigned int j = 0; j <= n; ++j)
    {
      if (j == 0)
        rhs[j] = system_.rhs;
      else
        system_.layout->reinit(rhs[j]);
      for (unsigned int c = 0; c < B_.size(); ++c)
        if (const double factor = j == 0 ? -p(c) : P(c, j - 1); factor != 0.)
          rhs[j].add(factor, B_[c]);
    }
    std::vector<const BlockVector *> pointers;
    for (const BlockVector &one : rhs)
      pointers.push_back(&one);
    report_ = solve(pointers, x_);

    dealii::FullMatrix<double> DP(P.m(), n);
    dealii::Vector<double>     Dp(P.m());
    D_.mmult(DP, P);
    D_.vmult(Dp, p);
    S_.reinit(n, n);
    s_.reinit(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      const BlockVector &row = C_[rows[i]];
      s_(i)                  = b(rows[i]) - Dp(rows[i]) - row * x_[0];
      for (unsigned int j = 0; j < n; ++j)
        S_(i, j) = DP(rows[i], j) - row * x_[j + 1];
    }
  }

  void BorderedSystem::expand(const dealii::Vector<double> &y, BlockVector &x) const
  {
    x = x_[0];
    for (unsigned int j = 0; j < y.size(); ++j)
      x.add(-y(j), x_[j + 1]);
  }
} // namespace Nodus
