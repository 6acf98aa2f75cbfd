#ifndef nodus_output_diagnosis_diagnosis_h
#define nodus_output_diagnosis_diagnosis_h

#include "contact/status.h"
#include "output/tables.h"
#include <nodus/base/types.h>
#include <nodus/parameters/parameters.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/vector.hpp>

#include <mpi.h>

#include <array>
#include <deque>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace Nodus
{
  /// What a failure is explained from: global values, the same on every rank.
  struct FailureEvidence
  {
    SolverFailure::Kind          kind = SolverFailure::Kind::unspecified;
    std::string                  message;   ///< of the failure
    double                       converged; ///< time of the last converged state
    LinearSolverParameters::Type linear_solver = LinearSolverParameters::Type::direct; ///< that was chosen
    std::string                  state; ///< file with the fields of this state; empty: none

    /// A displacement node out of balance.
    struct Node
    {
      unsigned int      body;
      Point             X, x; ///< reference and current position
      Vector3           force;
      unsigned int      pair = dealii::numbers::invalid_unsigned_int; ///< of a slave node with statuses
      std::vector<char> statuses;                                     ///< of that, as in Site

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &body &X &x &force &pair &statuses;
      }
    };
    std::vector<Node> worst_nodes;      ///< the largest force first
    double            force_scale = 0.; ///< what relative residuals refer to [force]

    /// A contact site whose status changed in the increment.
    struct Site
    {
      unsigned int      pair;
      bool              is_point; ///< an integration point, otherwise a slave node
      Point             X, x;
      StatusLedger      ledger;
      std::vector<char> statuses; ///< ContactStatus after the last tests, the oldest first

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &pair &is_point &X &x &ledger.changes &ledger.period &ledger.last &statuses;
      }
    };
    std::vector<Site> changing_sites; ///< the most changes first
    unsigned int      n_changed_sites = 0;

    bool may_shrink   = true;  ///< smaller increments are worth a try
    bool unstable     = false; ///< iterates had more negative eigenvalues than multipliers
    bool relaxed      = false; ///< relaxation was tried
    bool motion_known = false; ///< the state file has the motion that was resisted least

    std::vector<std::string> free_motions; ///< rigid motions that nothing resists (contact/free_motions.h)
    std::vector<std::string> left_free;    ///< what would be left of them if all sites with a master point were closed

    /// A soft spring against the free motions of a body.
    struct Spring
    {
      unsigned int          body, boundary_id;
      std::array<bool, dim> components;
      double                stiffness; ///< [pressure/length]
    };
    std::vector<Spring> springs;

    struct Pair
    {
      unsigned int sites = 0, closed = 0, slipping = 0;
      unsigned int unpaired = 0;     ///< without master point
      unsigned int lost     = 0;     ///< closed at the start of the increment, without master point now
      Point        lost_X;           ///< reference position of the first of these
      double       sliding     = 0.; ///< largest tangential motion in the increment [face sizes]
      double       penetration = 0.; ///< largest of open sites [face sizes]
      double gap   = std::numeric_limits<double>::max(); ///< smallest of open sites with a master point [face sizes]
      double reach = 0., face_size = 0., master_face_size = 0.; ///< [length]
      double slave_over_master = 0.;    ///< how many times the slave is as stiff; 0 without friction
      bool   intruded          = false; ///< the judge refused how far its surfaces are in each other
    };
    std::vector<Pair> pairs;

    struct Cell
    {
      double       det_F = 1.; ///< the smallest
      unsigned int body  = 0;
      Point        X, x; ///< reference and current centre

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &det_F &body &X &x;
      }
    };
    Cell         worst_cell;
    unsigned int inverted_cells = 0, distorted_cells = 0; ///< with det F <= 0, and below Diagnosis::distorted

    /// Over-constraint: the slave node whose multiplier repeats another constraint.
    struct Constraint
    {
      unsigned int          pair = dealii::numbers::invalid_unsigned_int;
      Point                 X;
      Vector3               normal;
      bool                  friction = false; ///< a friction multiplier, otherwise the contact pressure
      std::array<bool, dim> prescribed{{false, false, false}}; ///< components of the slave node's displacement

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &pair &X &normal &friction &prescribed;
      }
    };
    Constraint constraint;
  };

  /// Collects what happens in the attempts at an increment, and writes diagnosis.md when the last one has failed: which
  /// loop, since when, where, the suspected causes with their evidence, and the parameters to change.
  class Diagnosis
  {
  public:
    /// @p parameters must outlive it.
    Diagnosis(const Parameters &parameters, MPI_Comm communicator);

    /// Cells with a smaller det F are called distorted.
    static constexpr double distorted = 0.2;

    /// Removes what an earlier run in the same folder left.
    void begin_run() const;
    void begin_increment(unsigned int increment, double begin, double end);
    /// Another attempt at the increment, with all loops that are part of Newton's iteration in @p merged ("" for none):
    /// what was collected in the one before counts no longer.
    void begin_attempt(const std::string &merged);
    void end_attempt(const std::string &reason);

    void add(const Tables::Iteration &iteration);
    /// A pass of one of the loops that has come to its end.
    struct Pass
    {
      std::string  loop;
      unsigned int number;
      double       value, tolerance; ///< of the criterion
      std::string  worst;
    };
    void add(const Pass &pass);
    /// Statuses of this rank's sites after a test; the last few are kept.
    void add_statuses(const std::vector<char> &statuses);
    /// Of one site after the last tests, the oldest first.
    std::vector<char> statuses(unsigned int site) const;

    struct Attempt
    {
      double      begin, end; ///< of the increment
      std::string merged, reason;
    };
    /// What is known of the last attempt, and what all attempts at this increment came to.
    struct History
    {
      unsigned int                   increment = 0;
      double                         begin = 0., end = 0.;
      std::vector<Attempt>           attempts;
      std::vector<Tables::Iteration> iterations;
      std::vector<Pass>              passes;
      std::vector<Pass>              threshold_passes; ///< of the threshold loop that the last attempt goes without
    };
    const History &history() const
    {
      return history_;
    }

    /// The first suspected cause and what is the most promising to change, in one sentence, the same on every rank.
    std::string summary(const FailureEvidence &evidence) const;
    /// The page. @returns what went wrong, on rank 0.
    std::string write(const FailureEvidence &evidence) const;

  private:
    const Parameters             &parameters_;
    MPI_Comm                      communicator_;
    History                       history_;
    std::deque<std::vector<char>> statuses_;
  };

  /// A cause that the evidence speaks for.
  struct SuspectedCause
  {
    std::string              name;
    std::vector<std::string> evidence;
    struct Change
    {
      std::string                                      key; ///< as --set takes it
      std::string                                      now, proposed, reason;
      std::vector<std::pair<std::string, std::string>> together = {}; ///< keys of the same section that go with it
      std::string                                      block = {}; ///< a subsection to append instead of a key to set
    };
    std::vector<Change> changes;
  };
  /// The most likely one first; never empty.
  std::vector<SuspectedCause>
  suspected_causes(const Parameters &parameters, const Diagnosis::History &history, const FailureEvidence &evidence);
} // namespace Nodus

#endif
