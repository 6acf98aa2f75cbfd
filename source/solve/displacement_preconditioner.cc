#include "solve/displacement_preconditioner.h"
#include "parallel/throw_everywhere.h"
#include "solve/multigrid/multigrid.h"
#include "solve/trilinos/assemble.h"
#include "solve/trilinos/open_multigrid.h"

#include <exception>
#include <string>
#include <utility>

namespace Nodus
{
  namespace
  {
    using Choice = LinearSolverParameters::Preconditioner;

    class OwnMultigrid : public DisplacementPreconditioner
    {
    public:
      explicit OwnMultigrid(const unsigned int smoother_sweeps)
          : smoother_sweeps_(smoother_sweeps)
      {
      }
      void set_up(const BlockCsrMatrix    &K,
                  Constraints              constraints,
                  std::vector<double>      modes,
                  const DisplacementNodes &nodes) override
      {
        release(); // before the next one takes as much memory
        matrix_    = std::make_unique<ConstrainedMatrix>(K, std::move(constraints));
        multigrid_ = std::make_unique<Multigrid>(K, *matrix_, std::move(modes), nodes, smoother_sweeps_);
      }
      void vmult(Vector &dst, const Vector &src) const override
      {
        multigrid_->vmult(dst, src);
      }
      void release() override
      {
        multigrid_.reset(); // refers to the matrix
        matrix_.reset();
      }

    private:
      const unsigned int                 smoother_sweeps_;
      std::unique_ptr<ConstrainedMatrix> matrix_;
      std::unique_ptr<Multigrid>         multigrid_;
    };

    class AssembledMultigrid : public DisplacementPreconditioner
    {
    public:
      explicit AssembledMultigrid(const Choice choice)
          : choice_(choice)
          , multigrid_(open_multigrid(choice))
      {
      }
      void set_up(const BlockCsrMatrix &K,
                  Constraints           constraints,
                  std::vector<double>   modes,
                  const DisplacementNodes & /*nodes*/) override
      {
        AssembledMatrix A    = assemble(K, constraints);
        const MPI_Comm  comm = A.communicator;
        std::string     problem; // what libraries throw is a failure of the linear solver like others, of all ranks
        try
        {
          multigrid_->set_up(std::move(A), modes);
        }
        catch (const std::exception &error)
        {
          problem = advice(error);
        }
        throw_everywhere<SolverFailure>(problem, comm, SolverFailure::Kind::linear_solver);
      }
      void vmult(Vector &dst, const Vector &src) const override
      {
        try
        {
          multigrid_->vmult(dst.begin(), src.begin());
        }
        catch (const std::exception &error)
        {
          throw SolverFailure(advice(error), SolverFailure::Kind::linear_solver);
        }
      }
      /// Aggregates are kept where the next matrix has its entries at the same places.
      void release() override
      {
      }

    private:
      std::string advice(const std::exception &error) const
      {
        return text_of(choice_) + ": " + error.what() + "; use 'Preconditioner = nodus'.";
      }

      const Choice                            choice_;
      const std::unique_ptr<OutsideMultigrid> multigrid_;
    };
  } // namespace

  std::unique_ptr<DisplacementPreconditioner> make_displacement_preconditioner(const Choice       choice,
                                                                               const unsigned int smoother_sweeps)
  {
    if (choice == Choice::nodus)
      return std::make_unique<OwnMultigrid>(smoother_sweeps);
    return std::make_unique<AssembledMultigrid>(choice);
  }

  void require_preconditioner(const Choice choice, const MPI_Comm communicator)
  {
    if (choice == Choice::nodus)
      return;
    std::string problem;
    try
    {
      open_multigrid(choice);
    }
    catch (const InputError &error)
    {
      problem = error.what();
    }
    throw_everywhere<InputError>(problem, communicator);
  }
} // namespace Nodus
