// Multigrid of ML on Epetra matrices: the shared library libnodus_ml.so.

#include "solve/trilinos/outside_multigrid.h"

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <ml_MultiLevelPreconditioner.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

namespace Nodus
{
  namespace
  {
    void check(const int error, const char *const what)
    {
      if (error < 0)
        throw std::runtime_error(std::string(what) + " failed with error " + std::to_string(error));
    }

    class MLMultigrid : public OutsideMultigrid
    {
    public:
      explicit MLMultigrid(const unsigned int smoother_sweeps)
          : smoother_sweeps_(smoother_sweeps)
      {
      }
      void set_up(AssembledMatrix A, const std::vector<double> &modes) override;
      void vmult(double *dst, const double *src) const override;

    private:
      void                   make_matrix();
      bool                   same_places(const AssembledMatrix &A, double *&values) const;
      Teuchos::ParameterList settings();

      const unsigned int                                   smoother_sweeps_;
      AssembledMatrix                                      A_; ///< has the entries of matrix_
      std::vector<double>                                  modes_;
      std::unique_ptr<Epetra_MpiComm>                      communicator_;
      std::unique_ptr<Epetra_Map>                          rows_, columns_;
      std::unique_ptr<Epetra_CrsMatrix>                    matrix_;
      std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> ml_;
    };

    Teuchos::ParameterList MLMultigrid::settings()
    {
      Teuchos::ParameterList list;
      ML_Epetra::SetDefaults("SA", list);
      list.set("ML output", getenv("ML_OUT") ? atoi(getenv("ML_OUT")) : 0);
      list.set("PDE equations", 3);
      list.set("null space: type", "pre-computed");
      list.set("null space: dimension", 6);
      list.set("null space: vectors", modes_.data());
      list.set("null space: add default vectors", false);
      list.set("aggregation: type", "Uncoupled");
      list.set("aggregation: threshold", getenv("ML_DROP") ? atof(getenv("ML_DROP")) : 0.);
      const std::string smoother = getenv("ML_SMOOTHER") ? getenv("ML_SMOOTHER") : "Chebyshev";
      list.set("smoother: type", smoother);
      list.set("smoother: sweeps", getenv("ML_SWEEPS") ? atoi(getenv("ML_SWEEPS")) : int(smoother_sweeps_));
      if (getenv("ML_ALPHA"))
        list.set("smoother: Chebyshev alpha", atof(getenv("ML_ALPHA")));
      list.set("coarse: type", "Amesos-KLU");
      list.set("coarse: max size", getenv("ML_COARSE") ? atoi(getenv("ML_COARSE")) : 400);
      list.set("reuse: enable", !getenv("ML_NOREUSE"));
      if (getenv("ML_EIGEN"))
        list.set("eigen-analysis: type", getenv("ML_EIGEN"));
      return list;
    }

    void MLMultigrid::make_matrix()
    {
      communicator_ = std::make_unique<Epetra_MpiComm>(A_.communicator);
      rows_         = std::make_unique<Epetra_Map>(-1, A_.n_owned, 0, *communicator_);
      const std::vector<int> unknowns(A_.unknowns.begin(), A_.unknowns.end()); // ML takes no larger numbers
      columns_ = std::make_unique<Epetra_Map>(-1, int(unknowns.size()), unknowns.data(), 0, *communicator_);
      std::vector<int> entries(A_.n_owned);
      for (int i = 0; i < A_.n_owned; ++i)
        entries[i] = A_.start[i + 1] - A_.start[i];
      matrix_ = std::make_unique<Epetra_CrsMatrix>(Copy, *rows_, *columns_, entries.data(), true);
      for (int i = 0; i < A_.n_owned; ++i)
        check(matrix_->InsertMyValues(i, entries[i], &A_.value[A_.start[i]], &A_.column[A_.start[i]]), "Epetra");
      A_.value  = std::vector<double>();
      A_.column = std::vector<int>();
      A_.start  = std::vector<std::size_t>();
      check(matrix_->FillComplete(*rows_, *rows_), "Epetra");
      check(matrix_->OptimizeStorage(), "Epetra");
    }

    /// Whether the entries of @p A on this rank are at the places of those of the matrix before, whose values it gets.
    bool MLMultigrid::same_places(const AssembledMatrix &A, double *&values) const
    {
      int *start, *column;
      return ml_ && matrix_->ExtractCrsDataPointers(start, column, values) == 0 && A.unknowns == A_.unknowns &&
             A.n_owned == A_.n_owned && std::equal(A.start.begin(), A.start.end(), start) &&
             std::equal(A.column.begin(), A.column.end(), column);
    }

    void MLMultigrid::set_up(AssembledMatrix A, const std::vector<double> &modes)
    {
      double *values = nullptr;
      int     same   = same_places(A, values) ? 1 : 0;
      MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_MIN, A.communicator);
      if (same && !getenv("ML_NOREUSE"))
      {
        std::copy(A.value.begin(), A.value.end(), values);
        A = AssembledMatrix();
        check(ml_->ReComputePreconditioner(), "ML");
        return;
      }
      ml_.reset();
      matrix_.reset();
      A_     = std::move(A);
      modes_ = modes;
      make_matrix();
      ml_ = std::make_unique<ML_Epetra::MultiLevelPreconditioner>(*matrix_, settings(), false);
      check(ml_->ComputePreconditioner(), "ML");
    }

    void MLMultigrid::vmult(double *const dst, const double *const src) const
    {
      const Epetra_Vector b(View, *rows_, const_cast<double *>(src));
      Epetra_Vector       x(View, *rows_, dst);
      check(ml_->ApplyInverse(b, x), "ML");
    }
  } // namespace
} // namespace Nodus

extern "C" Nodus::OutsideMultigrid *NODUS_OUTSIDE_MULTIGRID(const unsigned int smoother_sweeps)
{
  return new Nodus::MLMultigrid(smoother_sweeps);
}
