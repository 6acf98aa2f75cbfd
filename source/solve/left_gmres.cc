#include "solve/left_gmres.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int cycle_length = 60;
    /// By which a cycle may reduce the residual: single precision, and some room.
    constexpr double cycle_reduction = 1e-6;
    /// Of a preconditioned residual, against that of the right-hand side.
    constexpr double resolved = 1e-15;
    constexpr double infinity = std::numeric_limits<double>::infinity();

    /// Orthonormal vectors, in single precision.
    class Basis
    {
    public:
      explicit Basis(const MPI_Comm communicator)
          : communicator_(communicator)
      {
      }

      unsigned int size() const
      {
        return vectors_.size();
      }

      /// Takes v / norm in, and rounds @p v to it.
      void add(BlockVector &v, const double norm)
      {
        std::vector<float> &stored = vectors_.emplace_back();
        stored.reserve(v.block(0).locally_owned_size() + v.block(1).locally_owned_size());
        for (const Segment &w : segments(v))
          for (std::size_t i = 0; i < w.size; ++i)
          {
            stored.push_back(static_cast<float>(w.values[i] / norm));
            w.values[i] = stored.back();
          }
      }

      /// Makes @p w orthogonal to the basis. @returns its products with the vectors and, last, the norm that is left
      std::vector<double> orthogonalise(BlockVector &w) const
      {
        const unsigned int  n = size();
        std::vector<double> product(n + 1, 0.), again(n + 1, 0.);
        sweep(w, nullptr, product);
        dealii::Utilities::MPI::sum(product, communicator_, product);
        sweep(w, product.data(), again);
        dealii::Utilities::MPI::sum(again, communicator_, again);
        double square = again[n];
        for (unsigned int k = 0; k < n; ++k)
        {
          product[k] += again[k];
          square -= again[k] * again[k];
          again[k] = -again[k];
        }
        add_to(w, again.data());
        product[n] = std::isfinite(square) ? std::sqrt(std::max(square, 0.)) : square;
        return product;
      }

      /// w += sum_k factor[k] v_k
      void add_to(BlockVector &w, const double *factor) const
      {
        std::size_t offset = 0;
        for (const Segment &segment : segments(w))
        {
          for (std::size_t first = 0; first < segment.size; first += chunk)
            for (unsigned int k = 0; k < size(); ++k)
              add(vectors_[k].data() + offset + first,
                  factor[k],
                  segment.values + first,
                  std::min(chunk, segment.size - first));
          offset += segment.size;
        }
      }

    private:
      struct Segment
      {
        double     *values;
        std::size_t size;
      };
      /// Values at hand while the vectors pass by.
      static constexpr std::size_t chunk = 1024;

      static std::array<Segment, 2> segments(BlockVector &v)
      {
        std::array<Segment, 2> result;
        for (unsigned int i = 0; i < 2; ++i)
          result[i] = {v.block(i).begin(), v.block(i).locally_owned_size()};
        return result;
      }

      static void add(const float *v, const double factor, double *w, const std::size_t n)
      {
        for (std::size_t i = 0; i < n; ++i)
          w[i] += factor * v[i];
      }

      template <typename Number>
      static double product(const Number *v, const double *w, const std::size_t n)
      {
        typedef double Lanes __attribute__((vector_size(64)));
        typedef Number Stored __attribute__((vector_size(8 * sizeof(Number))));
        Lanes          sum[2] = {};
        std::size_t    i      = 0;
        for (; i + 16 <= n; i += 16)
          for (unsigned int part = 0; part < 2; ++part)
          {
            Stored stored;
            Lanes  values;
            std::memcpy(&stored, v + i + 8 * part, sizeof stored);
            std::memcpy(&values, w + i + 8 * part, sizeof values);
            sum[part] += __builtin_convertvector(stored, Lanes) * values;
          }
        double result = 0.;
        for (unsigned int lane = 0; lane < 8; ++lane)
          result += sum[0][lane] + sum[1][lane];
        for (; i < n; ++i)
          result += v[i] * w[i];
        return result;
      }

      /// Takes the @p products, unless null, off @p w and finds those of what is left, and its square.
      void sweep(BlockVector &w, const double *products, std::vector<double> &found) const
      {
        std::size_t offset = 0;
        for (const Segment &segment : segments(w))
        {
          for (std::size_t first = 0; first < segment.size; first += chunk)
          {
            const std::size_t n    = std::min(chunk, segment.size - first);
            double *const     here = segment.values + first;
            if (products)
              for (unsigned int k = 0; k < size(); ++k)
                add(vectors_[k].data() + offset + first, -products[k], here, n);
            for (unsigned int k = 0; k < size(); ++k)
              found[k] += product(vectors_[k].data() + offset + first, here, n);
            found[size()] += product(here, here, n);
          }
          offset += segment.size;
        }
      }

      const MPI_Comm                  communicator_;
      std::vector<std::vector<float>> vectors_;
    };

    /// The small least-squares problem |beta e_0 - H y|, H made triangular by rotations as its columns come.
    class LeastSquares
    {
    public:
      explicit LeastSquares(const double beta)
          : rhs_(1, beta)
      {
      }
      /// @param column of H, up to and with the entry below the diagonal
      void add(std::vector<double> column)
      {
        const unsigned int j = columns_.size();
        for (unsigned int i = 0; i < j; ++i)
          rotate(rotations_[i], column[i], column[i + 1]);
        const double length = std::hypot(column[j], column[j + 1]);
        rotations_.push_back(length > 0. ? Rotation{column[j] / length, column[j + 1] / length} : Rotation{1., 0.});
        rotate(rotations_.back(), column[j], column[j + 1]);
        rhs_.push_back(0.);
        rotate(rotations_.back(), rhs_[j], rhs_[j + 1]);
        columns_.push_back(std::move(column));
      }
      double residual() const
      {
        return std::abs(rhs_.back());
      }
      std::vector<double> solution() const
      {
        std::vector<double> y(rhs_.begin(), rhs_.end() - 1);
        for (unsigned int i = y.size(); i-- > 0;)
        {
          for (unsigned int j = i + 1; j < y.size(); ++j)
            y[i] -= columns_[j][i] * y[j];
          y[i] = columns_[i][i] != 0. ? y[i] / columns_[i][i] : 0.;
        }
        return y;
      }

    private:
      struct Rotation
      {
        double cosine, sine;
      };
      static void rotate(const Rotation &r, double &a, double &b)
      {
        const double first = r.cosine * a + r.sine * b;
        b                  = r.cosine * b - r.sine * a;
        a                  = first;
      }
      std::vector<double>              rhs_;
      std::vector<Rotation>            rotations_;
      std::vector<std::vector<double>> columns_;
    };
  } // namespace

  KrylovReport left_gmres(const SaddlePointOperator                                     &A,
                          const std::function<void(BlockVector &, const BlockVector &)> &preconditioner,
                          const BlockVector                                             &b,
                          const double                                                   tolerance,
                          const unsigned int                                             maximum_iterations,
                          BlockVector                                                   &x)
  {
    BlockVector  r(b), v, candidate;
    const double norm_b = b.l2_norm();
    double       norm_z = 0., target = .9 * tolerance, reachable = infinity;
    KrylovReport report{0, 1.};
    v.reinit(b);
    candidate.reinit(b);
    x = 0.;
    // The preconditioned residual is known in every step, and says when to look at the residual itself.
    bool done = false;
    while (!done && report.iterations < maximum_iterations)
    {
      preconditioner(v, r);
      const double beta = v.l2_norm();
      if (norm_z == 0.)
        norm_z = beta;
      // Not a number, or round-off in double precision: nothing can be done about that.
      if (!(beta < reachable && beta > resolved * norm_z))
        break;
      Basis        basis(A.communicator());
      LeastSquares problem(beta);
      double       norm = beta;
      bool         full = false;
      while (!full && !done)
      {
        basis.add(v, norm);
        A.vmult(r, v);
        preconditioner(v, r);
        std::vector<double> column = basis.orthogonalise(v);
        norm                       = column.back();
        problem.add(std::move(column));
        ++report.iterations;
        full = !(norm > 0.) || !std::isfinite(norm) || problem.residual() <= cycle_reduction * beta ||
               basis.size() == cycle_length || report.iterations == maximum_iterations;
        if (!full && problem.residual() > target * norm_z)
          continue;
        candidate = x;
        basis.add_to(candidate, problem.solution().data());
        A.vmult(r, candidate);
        r.sadd(-1., 1., b);
        report.residual = r.l2_norm() / norm_b;
        target = std::min(target, problem.residual() / norm_z * std::clamp(.5 * tolerance / report.residual, .3, 1.));
        done   = report.residual <= tolerance && problem.residual() <= .9 * tolerance * norm_z;
      }
      x         = candidate;
      reachable = problem.residual() <= cycle_reduction * beta ? .5 * beta : infinity;
    }
    return report;
  }
} // namespace Nodus
