#include "solve/multigrid/multigrid_level.h"
#include "solve/multigrid/aggregation.h"
#include "solve/multigrid/corner_transfer.h"

#include <deal.II/base/mpi.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Nodus
{
  MultigridLevel::MultigridLevel(const BlockCsrMatrix    &K,
                                 const ConstrainedMatrix &A,
                                 std::vector<double>      modes,
                                 const DisplacementNodes *corners,
                                 const unsigned int       smoother_sweeps)
      : A_(A)
      , sweeps_(smoother_sweeps)
  {
    for (auto *v : {&residual_, &update_, &product_})
      v->resize(dim * A.map().n_owned());
    make_diagonal(K);
    largest_eigenvalue_ = largest_eigenvalue();
    if (corners)
      transfer_ = std::make_unique<CornerTransfer>(A, modes, *corners);
    else
      transfer_ = std::make_unique<Aggregation>(K, A, std::move(modes), D_inverse_, 4. / 3. / largest_eigenvalue_);
  }

  void MultigridLevel::make_diagonal(const BlockCsrMatrix &K)
  {
    using Matrix3 = Eigen::Matrix3d;
    D_inverse_    = A_.diagonal_blocks(K);
    for (std::array<double, 9> &block : D_inverse_)
    {
      // an indefinite tangent must not make the smoother indefinite
      const Eigen::SelfAdjointEigenSolver<Matrix3> eigen(Eigen::Map<const Matrix3>(block.data()));
      Eigen::Vector3d                              inverse = eigen.eigenvalues().cwiseAbs();
      const double                                 largest = inverse.maxCoeff();
      for (unsigned int c = 0; c < dim; ++c)
        inverse[c] = inverse[c] > 1e-12 * largest ? 1. / inverse[c] : 0.;
      Eigen::Map<Matrix3>(block.data()) =
          eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
    }
  }

  void MultigridLevel::apply_diagonal(double *const dst, const double *const src) const
  {
    for (unsigned int i = 0; i < D_inverse_.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        dst[dim * i + c] = D_inverse_[i][dim * c] * src[dim * i] + D_inverse_[i][dim * c + 1] * src[dim * i + 1] +
                           D_inverse_[i][dim * c + 2] * src[dim * i + 2];
  }

  /// Lanczos: a few stiff nodes at the contact must not escape, as they may escape the power iteration.
  double MultigridLevel::largest_eigenvalue() const
  {
    constexpr unsigned int n_steps = 15;
    const unsigned int     n       = residual_.size();
    // v, z, w without the factor 1 / norm until both products of a step are known: one reduction for both
    std::vector<double> previous(n, 0.), &v = residual_, &z = update_, &w = product_;
    for (unsigned int i = 0; i < n; ++i) // rough, and the same on any number of ranks
      v[i] = std::sin(12.9898 * (dim * A_.map().global(i / dim) + i % dim + 1.));

    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n_steps), beside = Eigen::VectorXd::Zero(n_steps - 1);
    double          beta = 0.;
    for (unsigned int step = 0; step < n_steps; ++step)
    {
      apply_diagonal(z.data(), v.data());
      A_.vmult(w.data(), z.data());
      double products[] = {std::inner_product(v.begin(), v.end(), z.begin(), 0.),
                           std::inner_product(w.begin(), w.end(), z.begin(), 0.)};
      dealii::Utilities::MPI::sum(products, A_.map().communicator(), products);
      const double norm = std::sqrt(std::max(products[0], 0.));
      if (!(norm > 1e-12 * beta))
        break;
      if (step > 0)
        beside[step - 1] = norm;
      beta           = step > 0 ? norm : 0.;
      diagonal[step] = products[1] / products[0];
      for (unsigned int i = 0; i < n; ++i)
      {
        v[i] /= norm;
        w[i] = w[i] / norm - diagonal[step] * v[i] - beta * previous[i];
      }
      previous.swap(v);
      v.swap(w);
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen;
    eigen.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
    const double largest = eigen.eigenvalues().maxCoeff();
    return largest > 0. ? 1.05 * largest : 1.;
  }

  void MultigridLevel::smooth(double *const x, double *const r, const bool last) const
  {
    const double upper = largest_eigenvalue_, lower = upper / 15.;
    const double theta = .5 * (upper + lower), delta = .5 * (upper - lower), sigma = theta / delta;
    double       rho = 1. / sigma;
    for (unsigned int sweep = 0; sweep < sweeps_; ++sweep)
    {
      const double next = 1. / (2. * sigma - rho), factor = sweep == 0 ? 1. / theta : 2. * next / delta,
                   momentum = sweep == 0 ? 0. : next * rho;
      if (sweep > 0)
        rho = next;
      for (unsigned int i = 0; i < D_inverse_.size(); ++i)
      {
        const double *const D = D_inverse_[i].data(), *const ri = r + dim * i;
        for (unsigned int c = 0; c < dim; ++c)
        {
          double &update = update_[dim * i + c];
          update = momentum * update + factor * (D[dim * c] * ri[0] + D[dim * c + 1] * ri[1] + D[dim * c + 2] * ri[2]);
          x[dim * i + c] += update;
        }
      }
      if (last && sweep + 1 == sweeps_)
        return;
      A_.vmult(product_.data(), update_.data());
      for (unsigned int i = 0; i < product_.size(); ++i)
        r[i] -= product_[i];
    }
  }

  void MultigridLevel::pre_smooth(double *const x, const double *const b, double *const coarse) const
  {
    std::copy_n(b, residual_.size(), residual_.begin());
    std::fill_n(x, residual_.size(), 0.);
    smooth(x, residual_.data(), false);
    transfer_->restrict_to(coarse, residual_.data());
  }

  void MultigridLevel::post_smooth(double *const x, const double *const b, const double *const coarse) const
  {
    transfer_->add_prolongation(x, coarse);
    A_.vmult(product_.data(), x);
    for (unsigned int i = 0; i < residual_.size(); ++i)
      residual_[i] = b[i] - product_[i];
    smooth(x, residual_.data(), true);
  }
} // namespace Nodus
