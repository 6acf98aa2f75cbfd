#ifndef nodus_contact_surface_face_h
#define nodus_contact_surface_face_h

#include <nodus/base/types.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace Nodus
{
  /// A face with (degree+1)^2 nodes, lexicographic in its local coordinates (xi, eta) in [0, 1]^2.
  struct SurfaceFace
  {
    std::vector<unsigned int> nodes;       ///< indices into ContactSurfaces::nodes()
    double                    orientation; ///< +1 when x_xi x x_eta points out of the body, -1 otherwise
    unsigned int              owner;       ///< rank of the cell
    unsigned int              number  = 0; ///< in its pair and side on all ranks
    unsigned int              cell    = 0; ///< active cell index on its owner
    unsigned int              body    = 0; ///< its number, from 1
    unsigned int              refined = 0; ///< how often the run has split its cell

    /// Of pairs with self-contact: the corners of the face across the cell, in the order of this one's.
    std::array<unsigned int, 4> across = {};
    /// ... and what the face is in pairs that come before this one (FaceRecord::elsewhere).
    std::vector<unsigned int> elsewhere = {};

    /// A node of the face that hangs, and what it follows: indices into ContactSurfaces::nodes(), and weights.
    struct Follower
    {
      unsigned int                                 n; ///< of the face
      std::vector<std::pair<unsigned int, double>> masters;
    };
    std::vector<Follower> hanging = {};
    /// Slave faces: numbers of the slave nodes whose basis functions are not zero on the face, ...
    std::vector<unsigned int> slaves = {};
    std::vector<double> basis = {}; ///< ... and these in the face's shape functions, [node][slave]; empty: the same

    /// Of each node, this face's in the averaged normal there (eq. P7).
    std::array<double, 9> normal_share = {{1., 1., 1., 1., 1., 1., 1., 1., 1.}};

    const Follower *follower(const unsigned int n) const
    {
      for (const Follower &follower : hanging)
        if (follower.n == n)
          return &follower;
      return nullptr;
    }
    /// Values of the slave nodes' basis functions, from those of the shape functions or the like of the nodes.
    template <typename Values>
    std::array<double, 9> slave_values(const Values &nodal) const
    {
      std::array<double, 9> result{};
      for (unsigned int j = 0; j < slaves.size(); ++j)
        if (basis.empty())
          result[j] = nodal[j];
        else
          for (unsigned int n = 0; n < nodes.size(); ++n)
            result[j] += basis[n * slaves.size() + j] * nodal[n];
      return result;
    }
  };

  /// What carries multipliers: a node on the slave side of a pair. On an edge where the slave surfaces of two pairs
  /// meet there is one for each of them.
  struct SlaveNode
  {
    unsigned int node; ///< index into ContactSurfaces::nodes()
    unsigned int pair;
  };

  /// An integration point of a slave face with statuses of its own (scheme `integration point`).
  struct SlavePoint
  {
    unsigned int pair, face;      ///< face: index into slave_faces(pair)
    double       xi, eta, weight; ///< of the rule on [0, 1]^2
  };

  /// Whether faces, or nodes, of a surface that touches itself meet in a pair that comes before it, one as slave and
  /// the other as master there (FaceRecord::elsewhere).
  inline bool meet_elsewhere(const std::vector<unsigned int> &a, const std::vector<unsigned int> &b)
  {
    return std::any_of(
        a.begin(), a.end(), [&](const unsigned int side) { return std::count(b.begin(), b.end(), side ^ 1u) > 0; });
  }

  /// Values and derivatives of the face shape functions at one point.
  struct FaceShape
  {
    unsigned int          n; ///< (degree+1)^2
    std::array<double, 9> value, d_xi, d_eta;
    FaceShape(unsigned int degree, double xi, double eta); // inline: often nothing but values is wanted

  private:
    static void lagrange(unsigned int degree, double s, double value[3], double derivative[3]);
  };

  inline void FaceShape::lagrange(const unsigned int degree, const double s, double value[3], double derivative[3])
  {
    if (degree == 1)
    {
      value[0]      = 1 - s;
      value[1]      = s;
      derivative[0] = -1;
      derivative[1] = 1;
    }
    else
    {
      value[0]      = (2 * s - 1) * (s - 1);
      value[1]      = 4 * s * (1 - s);
      value[2]      = s * (2 * s - 1);
      derivative[0] = 4 * s - 3;
      derivative[1] = 4 - 8 * s;
      derivative[2] = 4 * s - 1;
    }
  }

  inline FaceShape::FaceShape(const unsigned int degree, const double xi, const double eta)
      : n((degree + 1) * (degree + 1))
  {
    double a[3], da[3], b[3], db[3];
    lagrange(degree, xi, a, da);
    lagrange(degree, eta, b, db);
    for (unsigned int j = 0, k = 0; j <= degree; ++j)
      for (unsigned int i = 0; i <= degree; ++i, ++k)
      {
        value[k] = a[i] * b[j];
        d_xi[k]  = da[i] * b[j];
        d_eta[k] = a[i] * db[j];
      }
  }

  /// Position and tangents of a face at a shape point.
  struct FaceGeometry
  {
    Point   x;
    Vector3 d_xi, d_eta;
    FaceGeometry(const SurfaceFace &face, const FaceShape &shape, const std::vector<Point> &positions)
    {
      for (unsigned int n = 0; n < shape.n; ++n)
        add(shape, n, positions[face.nodes[n]]);
    }
    /// @p points: as many positions as the shape has functions.
    FaceGeometry(const FaceShape &shape, const Point *const points)
    {
      for (unsigned int n = 0; n < shape.n; ++n)
        add(shape, n, points[n]);
    }
    FaceGeometry(const Point &x_, const Vector3 &along_xi, const Vector3 &along_eta)
        : x(x_)
        , d_xi(along_xi)
        , d_eta(along_eta)
    {
    }
    /// x_xi x x_eta, length = surface element.
    Vector3 area_vector() const
    {
      return dealii::cross_product_3d(d_xi, d_eta);
    }

  private:
    void add(const FaceShape &shape, const unsigned int n, const Point &p)
    {
      x += shape.value[n] * p;
      d_xi += shape.d_xi[n] * p;
      d_eta += shape.d_eta[n] * p;
    }
  };
} // namespace Nodus

#endif
