// Multigrid of MueLu on Tpetra matrices: the shared library libnodus_muelu.so.

#include "solve/trilinos/outside_multigrid.h"

#include <MueLu_CreateTpetraPreconditioner.hpp>
#include <MueLu_TpetraOperator.hpp>
#include <Teuchos_DefaultMpiComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace Nodus
{
  namespace
  {
    using Teuchos::RCP;
    using Teuchos::rcp;
    using Map         = Tpetra::Map<>;
    using Local       = Map::local_ordinal_type;
    using Global      = Map::global_ordinal_type;
    using Matrix      = Tpetra::CrsMatrix<double>;
    using MultiVector = Tpetra::MultiVector<double>;
    using Operator    = MueLu::TpetraOperator<double, Local, Global, Map::node_type>;

    class MueLuMultigrid : public OutsideMultigrid
    {
    public:
      void set_up(AssembledMatrix A, const std::vector<double> &modes) override;
      void vmult(double *dst, const double *src) const override;

    private:
      void             make_matrix();
      bool             same_places(const AssembledMatrix &A) const;
      RCP<MultiVector> make_nullspace(const std::vector<double> &modes) const;

      AssembledMatrix          A_; ///< without its entries, which are in matrix_
      RCP<const Map>           rows_;
      RCP<Matrix>              matrix_;
      RCP<Operator>            muelu_;
      mutable RCP<MultiVector> b_, x_;
    };

    /// Smoothed aggregation with what was fastest of the settings in contrib/studies/scaling/preconditioners.md.
    Teuchos::ParameterList settings(const bool several_ranks)
    {
      Teuchos::ParameterList list, smoothing, coarse_smoothing;
      list.set("verbosity", "none");
      list.set("multigrid algorithm", "sa");
      list.set("number of equations", 3);
      list.set("problem: symmetric", true);
      list.set("transpose: use implicit", true);
      list.set("aggregation: type", "uncoupled");
      list.set("aggregation: drop tol", 0.03);
      list.set("coarse: max size", 400);
      list.set("coarse: type", several_ranks ? "RELAXATION" : "KLU2");
      if (several_ranks) // KLU2's solutions spoil the symmetry there (Trilinos 13.2)
      {
        coarse_smoothing.set("relaxation: type", "Symmetric Gauss-Seidel");
        coarse_smoothing.set("relaxation: sweeps", 4);
        list.set("coarse: params", coarse_smoothing);
      }
      // stiff nodes at the contact escape the ten iterations that are usual, and Chebyshev's polynomial loses its sign
      list.set("sa: eigenvalue estimate num iterations", 20);
      smoothing.set("chebyshev: eigenvalue max iterations", 20);
      smoothing.set("chebyshev: degree", 2);
      smoothing.set("chebyshev: ratio eigenvalue", 10.);
      list.set("smoother: type", "CHEBYSHEV");
      list.set("smoother: params", smoothing);
      list.set("reuse: type", "RP");
      return list;
    }

    /// What was in @p numbers, which give up their memory.
    template <typename View, typename Number>
    View taken(std::vector<Number> &numbers)
    {
      View view(Kokkos::view_alloc(Kokkos::WithoutInitializing, "nodus"), numbers.size());
      std::copy(numbers.begin(), numbers.end(), view.data());
      std::vector<Number>().swap(numbers);
      return view;
    }

    void MueLuMultigrid::make_matrix()
    {
      const auto comm = rcp(new Teuchos::MpiComm<int>(Teuchos::opaqueWrapper(A_.communicator)));
      rows_           = rcp(
          new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), static_cast<size_t>(A_.n_owned), 0, comm));
      const auto columns = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                                       std::vector<Global>(A_.unknowns.begin(), A_.unknowns.end()),
                                       0,
                                       comm));
      using LocalMatrix  = Matrix::local_matrix_device_type;
      matrix_            = rcp(new Matrix(rows_,
                               columns,
                               taken<LocalMatrix::row_map_type::non_const_type>(A_.start),
                               taken<LocalMatrix::index_type::non_const_type>(A_.column),
                               taken<LocalMatrix::values_type::non_const_type>(A_.value)));
      matrix_->expertStaticFillComplete(rows_, rows_);
      b_ = rcp(new MultiVector(rows_, 1));
      x_ = rcp(new MultiVector(rows_, 1));
    }

    bool MueLuMultigrid::same_places(const AssembledMatrix &A) const
    {
      const auto graph = matrix_->getLocalMatrixHost().graph;
      return A.unknowns == A_.unknowns && A.start.size() == graph.row_map.size() &&
             A.column.size() == graph.entries.size() &&
             std::equal(A.start.begin(), A.start.end(), graph.row_map.data()) &&
             std::equal(A.column.begin(), A.column.end(), graph.entries.data());
    }

    /// Modes vanish in what is held, and MueLu refuses aggregates in which one of them vanishes: small numbers there.
    RCP<MultiVector> MueLuMultigrid::make_nullspace(const std::vector<double> &modes) const
    {
      constexpr unsigned int n_modes   = 6;
      constexpr double       small     = 1e-5;
      const int              n         = A_.n_owned;
      const auto             nullspace = rcp(new MultiVector(rows_, n_modes));
      std::vector<char>      held(n, 1);
      for (unsigned int mode = 0; mode < n_modes; ++mode)
        for (int i = 0; i < n; ++i)
          held[i] = held[i] && modes[mode * n + i] == 0.;
      for (unsigned int mode = 0; mode < n_modes; ++mode)
      {
        const auto column = nullspace->getDataNonConst(mode);
        for (int i = 0; i < n; ++i)
          column[i] = held[i] ? small * std::cos((mode + 1.) * A_.unknowns[i]) : modes[mode * n + i];
      }
      return nullspace;
    }

    void MueLuMultigrid::set_up(AssembledMatrix A, const std::vector<double> &modes)
    {
      int same = !muelu_.is_null() && same_places(A) ? 1 : 0;
      MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, A.communicator);
      if (same)
      {
        std::copy(A.value.begin(), A.value.end(), matrix_->getLocalMatrixHost().values.data());
        A = AssembledMatrix();
        MueLu::ReuseTpetraPreconditioner(matrix_, *muelu_);
        return;
      }
      muelu_  = Teuchos::null;
      matrix_ = Teuchos::null;
      A_      = std::move(A);
      make_matrix();
      const RCP<MultiVector> nullspace = make_nullspace(modes);
      Teuchos::ParameterList list      = settings(rows_->getComm()->getSize() > 1);
      list.sublist("user data").set("Nullspace", nullspace);
      muelu_ = MueLu::CreateTpetraPreconditioner(RCP<Tpetra::Operator<double>>(matrix_), list);
    }

    void MueLuMultigrid::vmult(double *const dst, const double *const src) const
    {
      std::copy_n(src, A_.n_owned, b_->getDataNonConst(0).get());
      muelu_->apply(*b_, *x_);
      std::copy_n(x_->getData(0).get(), A_.n_owned, dst);
    }
  } // namespace
} // namespace Nodus

extern "C" Nodus::OutsideMultigrid *NODUS_OUTSIDE_MULTIGRID()
{
  return new Nodus::MueLuMultigrid;
}
