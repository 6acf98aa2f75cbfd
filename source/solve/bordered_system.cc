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
                                 const std::vector<unsigned int>  &rows,
                                 const std::vector<RightHandSide> &rhs)
  {
    const unsigned int       n = P.n(), n_rhs = rhs.size();
    std::vector<BlockVector> all(n_rhs + n);
    for (unsigned int j = 0; j < all.size(); ++j)
    {
      if (j < n_rhs)
        all[j] = *rhs[j].a;
      else
        system_.layout->reinit(all[j]);
      for (unsigned int c = 0; c < B_.size(); ++c)
        if (const double factor = j < n_rhs ? -rhs[j].p(c) : P(c, j - n_rhs); factor != 0.)
          all[j].add(factor, B_[c]);
    }
    std::vector<const BlockVector *> pointers;
    for (const BlockVector &one : all)
      pointers.push_back(&one);
    report_ = solve(pointers, x_);

    dealii::FullMatrix<double> DP(P.m(), n);
    D_.mmult(DP, P);
    S_.reinit(n, n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        S_(i, j) = DP(rows[i], j) - C_[rows[i]] * x_[n_rhs + j];
    s_.assign(n_rhs, dealii::Vector<double>(n));
    for (unsigned int k = 0; k < n_rhs; ++k)
    {
      dealii::Vector<double> Dp(P.m());
      D_.vmult(Dp, rhs[k].p);
      for (unsigned int i = 0; i < n; ++i)
        s_[k](i) = rhs[k].b(rows[i]) - Dp(rows[i]) - C_[rows[i]] * x_[k];
    }
  }

  void BorderedSystem::expand(const unsigned int k, const dealii::Vector<double> &y, BlockVector &x) const
  {
    x = x_[k];
    for (unsigned int j = 0; j < y.size(); ++j)
      x.add(-y(j), x_[s_.size() + j]);
  }
} // namespace Nodus
