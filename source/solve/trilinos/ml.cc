// Multigrid of ML on Epetra matrices: the shared library libnodus_ml.so.

#include "solve/trilinos/outside_multigrid.h"

#include <Epetra_CrsMatrix.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <ml_MultiLevelPreconditioner.h>

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
        throw std::runtime_error(std::string(what) + " fails with error " + std::to_string(error));
    }

    class MLMultigrid : public OutsideMultigrid
    {
    public:
      void set_up(AssembledMatrix A, const std::vector<double> &modes) override;
      void vmult(double *dst, const double *src) const override;

    private:
      void                   make_matrix(AssembledMatrix A);
      Teuchos::ParameterList settings();

      std::vector<double>                                  modes_;
      std::unique_ptr<Epetra_MpiComm>                      communicator_;
      std::unique_ptr<Epetra_Map>                          rows_;
      std::unique_ptr<Epetra_CrsMatrix>                    matrix_;
      std::unique_ptr<ML_Epetra::MultiLevelPreconditioner> ml_;
    };

    /// Smoothed aggregation with what was fastest of the settings in contrib/studies/scaling/preconditioners.md.
    Teuchos::ParameterList MLMultigrid::settings()
    {
      Teuchos::ParameterList list;
      ML_Epetra::SetDefaults("SA", list);
      list.set("ML output", 0);
      list.set("PDE equations", 3);
      list.set("null space: type", "pre-computed");
      list.set("null space: dimension", 6);
      list.set("null space: vectors", modes_.data());
      list.set("null space: add default vectors", false);
      list.set("aggregation: type", "Uncoupled");
      list.set("aggregation: threshold", 0.03);
      list.set("smoother: type", "Chebyshev");
      list.set("smoother: sweeps", 2); // the degree
      list.set("coarse: type", "Amesos-KLU");
      list.set("coarse: max size", 400);
      return list;
    }

    void MLMultigrid::make_matrix(AssembledMatrix A)
    {
      communicator_ = std::make_unique<Epetra_MpiComm>(A.communicator);
      rows_         = std::make_unique<Epetra_Map>(-1, A.n_owned, 0, *communicator_);
      const std::vector<int> unknowns(A.unknowns.begin(), A.unknowns.end()); // ML has numbers of 32 bits
      const Epetra_Map       columns(-1, static_cast<int>(unknowns.size()), unknowns.data(), 0, *communicator_);
      std::vector<int>       entries(A.n_owned);
      for (int i = 0; i < A.n_owned; ++i)
        entries[i] = static_cast<int>(A.start[i + 1] - A.start[i]);
      matrix_ = std::make_unique<Epetra_CrsMatrix>(Copy, *rows_, columns, entries.data(), true);
      for (int i = 0; i < A.n_owned; ++i)
        check(matrix_->InsertMyValues(i, entries[i], &A.value[A.start[i]], &A.column[A.start[i]]), "Epetra");
      check(matrix_->FillComplete(*rows_, *rows_), "Epetra");
      check(matrix_->OptimizeStorage(), "Epetra");
    }

    void MLMultigrid::set_up(AssembledMatrix A, const std::vector<double> &modes)
    {
      ml_.reset();
      matrix_.reset();
      modes_ = modes;
      make_matrix(std::move(A));
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

extern "C" Nodus::OutsideMultigrid *NODUS_OUTSIDE_MULTIGRID()
{
  return new Nodus::MLMultigrid;
}
