#ifndef nodus_run_load_stepping_h
#define nodus_run_load_stepping_h

#include <nodus/parameters/parameters.h>

#include <cstdint>

namespace Nodus
{
  /// A step on the load path: what is solved for, and where its interval begins and ends.
  struct Increment
  {
    unsigned int number = 0; ///< from 1
    double       begin = 0., end = 0.;
    double       interval_begin = 0., interval_end = 0.;
    bool         ends_interval = false;

    double duration() const
    {
      return end - begin;
    }
    /// Equilibrium is found where the last increment ended, on another mesh.
    bool on_new_mesh() const
    {
      return begin == end;
    }
    bool begins_interval() const
    {
      return begin == interval_begin;
    }
    /// What is left at time @p t of the reactions that are released in the interval.
    double left_to_release(const double t) const
    {
      return (interval_end - t) / (interval_end - interval_begin);
    }
  };

  /// Where a run is on its load path: time, increments and retries, no physics.
  ///
  /// An interval is divided into the increments that the user asks for. One that fails is halved, and after an easy one
  /// the next is twice as large again, so that the times asked for are met; beyond those, increments grow only when the
  /// user allows it. All times are exact fractions of the interval: they are the same in whatever steps it was
  /// travelled.
  class LoadStepping
  {
  public:
    explicit LoadStepping(const LoadSteppingParameters &parameters);

    /// The last interval has come to its end.
    bool finished() const
    {
      return interval_ == parameters_.interval_ends.size();
    }
    /// Number of the increment at hand, from 1.
    unsigned int increment() const
    {
      return increment_;
    }
    /// Time of the last converged increment, and the one that the increment at hand goes to.
    double time() const
    {
      return time_of(position_);
    }
    double target() const
    {
      return time_of(end_position());
    }
    double interval_begin() const
    {
      return interval_ == 0 ? 0. : parameters_.interval_ends[interval_ - 1];
    }
    double interval_end() const
    {
      return parameters_.interval_ends[interval_];
    }
    /// The increment at hand is the last one of its interval.
    bool ends_interval() const
    {
      return end_position() == n_ticks_;
    }
    /// The one to solve next, and the standstill at the time that has been reached.
    Increment at_hand() const
    {
      return {increment_, time(), target(), interval_begin(), interval_end(), ends_interval()};
    }
    Increment standstill() const
    {
      return {increment_, time(), time(), interval_begin(), interval_end(), time() == interval_begin()};
    }
    /// Part of the whole path that is done, 0 to 1.
    double progress() const
    {
      return finished() ? 1. : time() / parameters_.interval_ends.back();
    }

    /// The increment at hand converged in so many Newton iterations. Goes on to the next one, larger if @p smooth
    /// (without fallback) and the iterations were few.
    void accept(unsigned int newton_iterations, bool smooth);
    /// The increment at hand failed: halves it. @returns false when it may not become smaller.
    bool cut_back();
    bool may_cut_back() const
    {
      return half() > 0;
    }
    /// Smallest increment of this interval that cut_back() leads to.
    double smallest() const;

    /// Goes on where @p saved was. If its parameters were others, the interval at hand is divided anew from there on.
    void continue_from(const LoadStepping &saved);

    template <typename Archive>
    void serialize(Archive &archive, const unsigned int)
    {
      archive &parameters_.interval_ends &parameters_.increments &parameters_.cut_back &parameters_
          .minimum_increment &parameters_.maximum_increment                                                &parameters_
          .easy_iterations &increment_ &interval_ &begin_ &n_increments_ &n_halvings_ &n_ticks_ &position_ &size_;
    }

  private:
    using Ticks = std::uint64_t;
    /// Divides what is left of the interval at hand from @p begin into increments of the size that the user asks for.
    void  divide(double begin);
    Ticks base() const
    {
      return Ticks(1) << n_halvings_;
    }
    Ticks  end_position() const;
    Ticks  half() const; ///< of the increment at hand, 0: none
    double time_of(Ticks position) const;

    LoadSteppingParameters parameters_;
    unsigned int           increment_ = 1, interval_ = 0;
    double                 begin_        = 0.; ///< from there on the interval at hand is divided
    unsigned int           n_increments_ = 1, n_halvings_ = 0;
    Ticks                  n_ticks_ = 1, position_ = 0, size_ = 1; ///< in the smallest increments
  };
} // namespace Nodus

#endif
