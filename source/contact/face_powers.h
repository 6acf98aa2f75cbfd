#ifndef nodus_contact_face_powers_h
#define nodus_contact_face_powers_h

#include <nodus/base/types.h>

#include <array>

namespace Nodus
{
  /// Three values that the shape functions of a face interpolate, in powers of its local coordinates: quick where they
  /// are asked for at many points.
  class FacePowers
  {
  public:
    /// In a register, the fourth is not used. Never handed over by value: how depends on the machine that is compiled
    /// for, which is not the same for all that includes this.
    typedef double Values __attribute__((vector_size(4 * sizeof(double))));

    static Vector3 vector(const Values &v)
    {
      return Vector3({v[0], v[1], v[2]});
    }

    /// @param node called as node(n) for the vectors at the (degree + 1)^2 nodes of the face
    template <typename Node>
    FacePowers(const unsigned int degree, const Node &node)
        : degree_(degree)
    {
      for (unsigned int j = 0, n = 0; j <= degree; ++j)
        for (unsigned int i = 0; i <= degree; ++i, ++n)
        {
          const Vector3 v    = node(n);
          powers_[3 * j + i] = Values{v[0], v[1], v[2], 0.};
        }
      for (unsigned int j = 0; j <= degree; ++j)
        make_powers(powers_.data() + 3 * j, 1);
      for (unsigned int i = 0; i <= degree; ++i)
        make_powers(powers_.data() + i, 3);
    }

    unsigned int degree() const
    {
      return degree_;
    }
    struct Tangents
    {
      Values x, d_xi, d_eta;
    };
    template <unsigned int degree>
    Tangents tangents(const double xi, const double eta) const
    {
      Tangents sum;
      for (unsigned int j = degree + 1; j-- > 0;)
      {
        const Values *const c = powers_.data() + 3 * j;
        Values              x, d_xi;
        if constexpr (degree == 1)
        {
          x    = c[0] + xi * c[1];
          d_xi = c[1];
        }
        else
        {
          x    = c[0] + xi * (c[1] + xi * c[2]);
          d_xi = c[1] + 2. * xi * c[2];
        }
        sum.d_eta = j == degree ? Values{} : sum.x + eta * sum.d_eta;
        sum.x     = j == degree ? x : x + eta * sum.x;
        sum.d_xi  = j == degree ? d_xi : d_xi + eta * sum.d_xi;
      }
      return sum;
    }
    Tangents tangents(const double xi, const double eta) const
    {
      return degree_ == 1 ? tangents<1>(xi, eta) : tangents<2>(xi, eta);
    }

  private:
    /// From values at equal distances on [0, 1], which are @p step apart.
    void make_powers(Values *const values, const unsigned int step) const
    {
      Values &first = values[0], &second = values[step];
      if (degree_ == 1)
      {
        second -= first;
        return;
      }
      Values      &third = values[2 * step];
      const Values last  = third;
      third              = 2. * (first - 2. * second + last);
      second             = last - first - third;
    }

    unsigned int          degree_;
    std::array<Values, 9> powers_; ///< of xi^i eta^j at 3 j + i
  };
} // namespace Nodus

#endif
