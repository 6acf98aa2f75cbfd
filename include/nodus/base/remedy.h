#ifndef nodus_base_remedy_h
#define nodus_base_remedy_h

#include <array>

namespace Nodus
{
  /// What is tried where something fails. First the attempts at an increment after the first one, in the order of the
  /// ladder (run/strategy.cc), then what helps inside an attempt. Each has a name for the parameter file, a column of
  /// contact.csv, and a row in the table of contrib/doc/architecture.md, which says what happens without it.
  enum class Remedy : unsigned int
  {
    three_loops,
    coupled_threshold,
    relaxation,
    mixed_geometry,
    mixed_thresholds,
    regularised_law,
    frozen_statuses,
    shorter_step,
    limited_step,
    direct_solver,
    second_pass
  };

  constexpr std::array<const char *, 11> remedy_names = {{"three loops",
                                                          "coupled threshold",
                                                          "relaxation",
                                                          "mixed geometry",
                                                          "mixed thresholds",
                                                          "regularised law",
                                                          "frozen statuses",
                                                          "shorter step",
                                                          "limited step",
                                                          "direct solver",
                                                          "second pass"}};

  /// A value for each remedy: how often it was used, whether it may be.
  template <typename T>
  class PerRemedy
  {
  public:
    T &operator[](const Remedy remedy)
    {
      return values_[static_cast<unsigned int>(remedy)];
    }
    const T &operator[](const Remedy remedy) const
    {
      return values_[static_cast<unsigned int>(remedy)];
    }
    auto begin() const
    {
      return values_.begin();
    }
    auto end() const
    {
      return values_.end();
    }

  private:
    std::array<T, remedy_names.size()> values_ = {};
  };
} // namespace Nodus

#endif
