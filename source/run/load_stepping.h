#ifndef nodus_run_load_stepping_h
#define nodus_run_load_stepping_h

#include <nodus/parameters/parameters.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace Nodus
{
  /// A step on the load path: what is solved for, and where its interval begins and ends.
  struct Increment
  {
    unsigned int number = 0; ///< from 1
    double       begin = 0., end = 0.;
    double       interval_begin = 0., interval_end = 0.;
    bool         ends_interval = false;
    bool         may_be_halved = false;
    double       viscosity     = 0.; ///< `Viscous stabilisation` of the interval
    /// The interval is under arc length: equilibria are followed whether they are stable or not.
    bool   follows_branch = false;
    double arc            = 0.; ///< motion along the last secant; 0: the first increment of an interval [length]

    /// The end is an unknown, which begins where the last increment ended.
    bool finds_time() const
    {
      return arc > 0. && !ends_interval;
    }
    /// Time that goes by, also where t goes back.
    double duration() const
    {
      return std::abs(end - begin);
    }
    /// Equilibrium is found where the last increment ended, on another mesh.
    bool on_new_mesh() const
    {
      return begin == end && arc == 0.;
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

  /// What an increment has come to: its time, and the largest displacement of a free node in it [length].
  struct Reached
  {
    double time = 0., motion = 0.;
  };

  /// Where a run is on its load path: time, increments and retries, no physics.
  ///
  /// An interval is divided into the increments that the user asks for. One that fails is halved, and after an easy one
  /// the next is twice as large again, so that the times asked for are met; beyond those, increments grow only when the
  /// user allows it. All times are exact fractions of the interval: they are the same in whatever steps it was
  /// travelled.
  ///
  /// In an interval under arc length the first increment is the first of these. From then on motions are given instead
  /// of times: that of the first increment, or the one asked for, which is halved where it fails and grows back
  /// likewise. An increment that would go beyond the end of the interval is tried as one that ends there, at a given
  /// time.
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
      return arc_ > 0. ? reached_ : time_of(position_);
    }
    double target() const
    {
      return arc_ == 0. ? time_of(end_position()) : closing_ ? interval_end() : reached_;
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
      return arc_ > 0. ? closing_ : end_position() == n_ticks_;
    }
    /// The one to solve next, and the standstill at the time that has been reached.
    Increment at_hand() const
    {
      return {increment_,
              time(),
              target(),
              interval_begin(),
              interval_end(),
              ends_interval(),
              may_cut_back(),
              parameters_.stabilisation(interval_),
              parameters_.has_arc_length(interval_),
              arc_};
    }
    Increment standstill() const
    {
      return {increment_,
              time(),
              time(),
              interval_begin(),
              interval_end(),
              time() == interval_begin(),
              false,
              parameters_.stabilisation(interval_),
              parameters_.has_arc_length(interval_)};
    }
    /// Times of increments to come as the user asks for them, and all ends of intervals; of intervals with very many
    /// increments some of them, and of those under arc length none.
    std::vector<double> planned_times() const;
    /// Part of the whole path that is done, 0 to 1.
    double progress() const
    {
      return finished() ? 1. : time() / parameters_.interval_ends.back();
    }

    /// The increment at hand converged in so many Newton iterations. Goes on to the next one, larger if @p smooth
    /// (without fallback) and the iterations were few. @p reached counts under arc length.
    void accept(unsigned int newton_iterations, bool smooth, const Reached &reached = {});
    /// The increment at hand failed: halves it. @returns false when it may not become smaller.
    bool cut_back();
    bool may_cut_back() const
    {
      return arc_ > 0. ? half_arc() > 0. : half() > 0;
    }
    /// The increment at hand goes beyond the end of the interval: it ends there.
    void close_interval()
    {
      closing_ = true;
    }
    /// The interval at hand has had all increments under arc length that it may have.
    bool exhausted() const
    {
      return arc_ > 0. && n_arcs_ >= parameters_.maximum_increments;
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
      archive &parameters_.control &parameters_.arc_length &reached_ &arc_ &longest_arc_ &n_arcs_ &closing_;
    }

  private:
    using Ticks = std::uint64_t;
    /// Divides what is left of the interval at hand from @p begin into increments of the size that the user asks for.
    void  divide(double begin);
    void  follow_arc(bool easy, const Reached &reached);
    Ticks base() const
    {
      return Ticks(1) << n_halvings_;
    }
    Ticks  end_position() const;
    Ticks  half() const;     ///< of the increment at hand, 0: none
    double half_arc() const; ///< likewise
    double time_of(Ticks position) const;

    LoadSteppingParameters parameters_;
    unsigned int           increment_ = 1, interval_ = 0;
    double                 begin_        = 0.; ///< from there on the interval at hand is divided
    unsigned int           n_increments_ = 1, n_halvings_ = 0;
    Ticks                  n_ticks_ = 1, position_ = 0, size_ = 1; ///< in the smallest increments
    double                 arc_ = 0., longest_arc_ = 0.; ///< at hand, 0: times are given; what it grows to [length]
    double                 reached_ = 0.;                ///< time of the last increment, under arc length
    unsigned int           n_arcs_  = 0;                 ///< increments of the interval under arc length
    bool                   closing_ = false;             ///< the one at hand ends the interval
  };
} // namespace Nodus

#endif
