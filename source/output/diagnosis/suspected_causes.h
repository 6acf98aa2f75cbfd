#ifndef nodus_output_diagnosis_suspected_causes_h
#define nodus_output_diagnosis_suspected_causes_h

#include "base/text.h"
#include "output/diagnosis/diagnosis.h"

namespace Nodus
{
  /// What the functions that find causes share, one function for each cause.
  namespace Suspects
  {
    using Kind    = SolverFailure::Kind;
    using Mode    = LoopParameters::Mode;
    using History = Diagnosis::History;
    using Causes  = std::vector<SuspectedCause>;

    /// Residuals that fall by this factor or less from one iteration or pass to the next do not converge.
    constexpr double no_contraction = 0.9;

    std::string joined(const std::vector<double> &values);
    std::string in_pair(const unsigned int pair, const std::string &key);
    std::string pair_name(const Parameters &parameters, const unsigned int pair);
    std::string body_name(const Parameters &parameters, const unsigned int body);
    /// Geometric mean of the ratios of the last few values; 1 for fewer than two.
    double              contraction(const std::vector<double> &values);
    std::vector<double> last_of(const std::vector<double> &values, const std::size_t n);
    /// "1, 2": values of a key.
    template <typename Value>
    std::string as_list(const std::vector<Value> &values)
    {
      std::string list;
      for (const Value &value : values)
        list += (list.empty() ? "" : ", ") + text(value);
      return list;
    }
    /// The one, from 0, that the increment at hand belongs to.
    std::size_t interval_of(const LoadSteppingParameters &load, const History &history);
    /// Smaller increments, in the terms of the user.
    void add_smaller_increments(const Parameters &parameters, const History &history, SuspectedCause &cause);
    void add_line_search(const Parameters &parameters, SuspectedCause &cause);
    /// Where points of a face share multipliers, or nodes the gaps of their neighbours, statuses may contradict each
    /// other; they do not where each node has a gap of its own.
    void add_own_gaps(const Parameters &parameters, const unsigned int pair, SuspectedCause &cause);
    void add_newton_mode(const std::string &loop, const LoopParameters &parameters, SuspectedCause &cause);
    void add_more_passes(const std::string &key,
                         const unsigned int now,
                         const double       rate,
                         const double       residual,
                         const double       tolerance,
                         SuspectedCause    &cause);
    /// Motions that nothing resists.
    void add_free_body(const Parameters      &parameters,
                       const History         &history,
                       const FailureEvidence &evidence,
                       Causes                &causes);
    /// It buckles, snaps through or softens.
    void add_instability(const Parameters      &parameters,
                         const History         &history,
                         const FailureEvidence &evidence,
                         Causes                &causes);
    /// Displacements of both sides of a contact are prescribed.
    void add_prescribed_contact(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes);
    /// Where gaps are taken at points of the slave, what is between these is not seen.
    void add_coarse_slave(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes);
    /// Edges that press are better slave than master.
    void add_edge_between_nodes(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes);
    /// A surface that is much softer than the other one is better slave than master.
    void add_stiff_slave(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes);
    void add_over_constraint(const Parameters &parameters, const FailureEvidence &evidence, Causes &causes);
    /// Statuses that come and go.
    void add_status_cycle(const Parameters      &parameters,
                          const History         &history,
                          const FailureEvidence &evidence,
                          Causes                &causes);
    void add_threshold_loop(const Parameters &parameters, const History &history, Causes &causes);
    void add_geometry_loop(const Parameters      &parameters,
                           const History         &history,
                           const FailureEvidence &evidence,
                           Causes                &causes);
  } // namespace Suspects
} // namespace Nodus

#endif
