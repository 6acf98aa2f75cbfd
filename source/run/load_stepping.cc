#include "run/load_stepping.h"

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// Halvings up to the smallest increment where the user names none, and the most that there can be.
    constexpr unsigned int default_halvings = 6, most_halvings = 20;
    /// Times that differ by less than this fraction of the path are the same.
    constexpr double same_time = 1e-12;
    /// Increments of an interval that planned_times() tells of, about.
    constexpr unsigned int most_planned = 32;
  } // namespace

  LoadStepping::LoadStepping(const LoadSteppingParameters &parameters)
      : parameters_(parameters)
  {
    divide(0.);
  }

  void LoadStepping::divide(const double begin)
  {
    begin_   = begin;
    arc_     = 0.;
    n_arcs_  = 0;
    closing_ = false;
    if (finished())
      return;
    const double wanted = (interval_end() - interval_begin()) / parameters_.increments[interval_];
    n_increments_       = parameters_.increments[interval_];
    if (begin > interval_begin())
      n_increments_ = std::max(1., std::ceil((interval_end() - begin) / wanted * (1. - same_time)));

    const double size     = (interval_end() - begin) / n_increments_;
    const double smallest = parameters_.minimum_increment * (1. - same_time);
    n_halvings_           = 0;
    while (parameters_.cut_back && n_halvings_ < (smallest > 0. ? most_halvings : default_halvings) &&
           std::ldexp(size, -static_cast<int>(n_halvings_) - 1) >= smallest)
      ++n_halvings_;
    n_ticks_  = n_increments_ * base();
    position_ = 0;
    size_     = base();
  }

  /// The next increment is under arc length.
  void LoadStepping::follow_arc(const bool easy, const Reached &reached)
  {
    if (arc_ == 0.)
      arc_ = longest_arc_ = parameters_.arc_length > 0. ? parameters_.arc_length : reached.motion;
    else if (easy)
      arc_ = std::min(2. * arc_, longest_arc_);
    reached_ = reached.time;
    ++n_arcs_;
  }

  LoadStepping::Ticks LoadStepping::end_position() const
  {
    return std::min(position_ + size_, n_ticks_);
  }

  double LoadStepping::time_of(const Ticks position) const
  {
    if (finished())
      return parameters_.interval_ends.back();
    return position == n_ticks_ ? interval_end()
                                : begin_ + (interval_end() - begin_) * (static_cast<double>(position) / n_ticks_);
  }

  std::vector<double> LoadStepping::planned_times() const
  {
    std::vector<double> times;
    for (unsigned int i = interval_; i < parameters_.interval_ends.size(); ++i)
    {
      if (parameters_.has_arc_length(i))
        continue;
      const double       begin = i == 0 ? 0. : parameters_.interval_ends[i - 1], end = parameters_.interval_ends[i];
      const unsigned int n = parameters_.increments[i], step = std::max(1u, n / most_planned);
      for (unsigned int k = step; k < n; k += step)
        if (const double t = begin + (end - begin) * (static_cast<double>(k) / n); t > time())
          times.push_back(t);
      times.push_back(end);
    }
    return times;
  }

  double LoadStepping::smallest() const
  {
    return (interval_end() - begin_) / n_ticks_;
  }

  void LoadStepping::accept(const unsigned int newton_iterations, const bool smooth, const Reached &reached)
  {
    const bool easy = smooth && newton_iterations <= parameters_.easy_iterations;
    ++increment_;
    if (ends_interval())
    {
      ++interval_;
      divide(interval_begin());
      return;
    }
    if (parameters_.has_arc_length(interval_) && reached.motion > 0.)
      return follow_arc(easy, reached);
    position_ = end_position();
    if (!easy)
      return;
    const Ticks twice = 2 * size_;
    // Up to the increments asked for only where it leads back to their times.
    if (twice <= base() ? position_ % twice == 0
                        : time_of(position_ + twice) - time() <= parameters_.maximum_increment * (1. + same_time))
      size_ = twice;
  }

  LoadStepping::Ticks LoadStepping::half() const
  {
    Ticks size = size_ / 2;
    while (size > 0 && position_ + size >= end_position()) // an increment that the end of the interval had shortened
      size /= 2;
    return parameters_.cut_back ? size : 0;
  }

  double LoadStepping::half_arc() const
  {
    const double smallest = std::ldexp(longest_arc_, -static_cast<int>(default_halvings));
    return parameters_.cut_back && arc_ >= 2. * smallest ? 0.5 * arc_ : 0.;
  }

  bool LoadStepping::cut_back()
  {
    if (!may_cut_back())
      return false;
    if (arc_ > 0.)
    {
      arc_     = half_arc();
      closing_ = false;
      return true;
    }
    size_ = half();
    return true;
  }

  void LoadStepping::continue_from(const LoadStepping &saved)
  {
    const LoadSteppingParameters asked = parameters_;
    const auto                  &then  = saved.parameters_;
    if (asked.interval_ends == then.interval_ends && asked.increments == then.increments &&
        asked.cut_back == then.cut_back && asked.minimum_increment == then.minimum_increment &&
        asked.control == then.control)
    {
      *this       = saved;
      parameters_ = asked;
      if (arc_ > 0. && asked.arc_length > 0. && asked.arc_length != then.arc_length)
        arc_ = longest_arc_ = asked.arc_length;
      return;
    }
    const double time = saved.time();
    increment_        = saved.increment_;
    interval_         = 0;
    while (!finished() && interval_end() - time <= same_time * parameters_.interval_ends.back())
      ++interval_;
    divide(finished() ? time : std::max(time, interval_begin()));
  }
} // namespace Nodus
