#ifndef nodus_output_status_file_h
#define nodus_output_status_file_h

#include <nodus/contact/contact_fields.h>

#include <chrono>
#include <string>

namespace Nodus
{
  /// status.json of a results folder: where a run is, for whoever watches it (contrib/plot/watch). Written anew after
  /// each increment and as the run ends; complete at any time. To be kept by the first rank alone. A file that cannot
  /// be written is no reason to end a run: the next one is tried.
  class StatusFile
  {
  public:
    /// @param end_time of the load path; @param done part of it that lies behind a run that continues another one.
    StatusFile(std::string folder, double end_time, double done, unsigned int n_ranks);

    /// An increment that ends at @p time has converged, at the part @p done of the load path.
    void add(unsigned int increment, double time, double done, const IterationCounts &counts);
    /// @param state "finished", "stopped" or "interrupted"; @param message why, for people.
    void end(const std::string &state, const std::string &message);

  private:
    void write(const std::string &state, const std::string &message) const;

    const std::string                           folder_;
    const double                                end_time_, done_at_start_;
    const unsigned int                          n_ranks_;
    const std::string                           started_; ///< UTC
    const std::chrono::steady_clock::time_point start_;
    unsigned int                                increment_ = 0;
    double                                      time_ = 0., done_ = 0.;
    IterationCounts                             counts_;     ///< of the last increment
    unsigned int                                newton_ = 0; ///< of all increments of this run
  };
} // namespace Nodus

#endif
