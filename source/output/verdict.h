#ifndef nodus_output_verdict_h
#define nodus_output_verdict_h

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace Nodus
{
  /// What the judge measures, columns of contact.csv.
  enum class Measure : unsigned int
  {
    numbers,      ///< that are none, or infinite, in state and forces
    prescribed,   ///< displacements that are not what is prescribed, relative to the step
    nodes,        ///< force out of balance at a node, relative to the largest one (eq. N3)
    bodies,       ///< resultant and moment of what is out of balance on a body, relative to its forces
    pair_forces,  ///< both sides of a pair together, relative to the sum of its nodal forces
    pair_moments, ///< likewise, with the mean face as lever
    contact_laws, ///< eq. N4
    statuses,     ///< that are contradicted, relative to the largest pressure or to the cone (eq. S2)
    thresholds,   ///< of friction, from those of the pressure, relative to the largest one (eq. L2)
    held_depth,   ///< of sites where prescribed displacements hold both sides across the surface [mean face]
    held_slip,    ///< of closed sites with friction where they hold both sides along it [mean face]
    penetration,  ///< of the surfaces of a pair, either way [mean face of the side with the smaller ones]
    unseen_depth, ///< likewise, of a pair without a closed site
    passed        ///< nodes that have gone through the other surface
  };
  constexpr unsigned int                         n_measures    = static_cast<unsigned int>(Measure::passed) + 1;
  constexpr std::array<const char *, n_measures> measure_names = {{"infinite numbers",
                                                                   "prescribed displacements",
                                                                   "out of balance: nodes",
                                                                   "out of balance: bodies",
                                                                   "pair forces",
                                                                   "pair moments",
                                                                   "contact laws",
                                                                   "contradicted statuses",
                                                                   "thresholds",
                                                                   "prescribed penetration",
                                                                   "prescribed slip",
                                                                   "penetration depth",
                                                                   "penetration unseen",
                                                                   "nodes passed through"}};

  /// What the judge found in a state, the same on every rank.
  class Verdict
  {
  public:
    struct Finding
    {
      double       value = 0., tolerance = 0.;
      std::string  where;                                       ///< in words, may be empty
      unsigned int pair = std::numeric_limits<unsigned>::max(); ///< contact pair, from 0, where one is to blame

      bool holds() const
      {
        return value <= tolerance; // not where it is no number
      }
      /// Takes a larger value; where it is a number no more, that.
      void raise(const double       other,
                 const std::string &there,
                 const unsigned int of_pair = std::numeric_limits<unsigned>::max())
      {
        if (other <= value)
          return;
        value = other;
        where = there;
        pair  = of_pair;
      }
      /// Part of the tolerance that is used up; that of a tolerance of zero does not count unless it is violated.
      double share() const
      {
        return holds() ? (tolerance > 0. ? value / tolerance : 0.) : HUGE_VAL;
      }
    };

    Finding &operator[](const Measure measure)
    {
      return findings_[static_cast<unsigned int>(measure)];
    }
    const Finding &operator[](const Measure measure) const
    {
      return findings_[static_cast<unsigned int>(measure)];
    }
    auto begin() const
    {
      return findings_.begin();
    }
    auto end() const
    {
      return findings_.end();
    }
    bool holds() const
    {
      return std::all_of(begin(), end(), [](const Finding &finding) { return finding.holds(); });
    }
    /// The measure with the largest share of its tolerance: the first that is violated, where one is.
    Measure worst() const
    {
      return static_cast<Measure>(
          std::max_element(begin(), end(), [](const Finding &a, const Finding &b) { return a.share() < b.share(); }) -
          begin());
    }
    /// Takes over what is worse in @p other.
    void merge(const Verdict &other);
    /// "penetration depth 0.31, tolerance 0.25, slave node ...".
    std::string text(Measure measure) const;

  private:
    std::array<Finding, n_measures> findings_;
  };
} // namespace Nodus

#endif
