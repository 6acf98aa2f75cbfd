#ifndef nodus_contact_surface_face_h
#define nodus_contact_surface_face_h

#include <nodus/types.h>

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
    unsigned int              number = 0;  ///< in its pair and side on all ranks
    unsigned int              cell   = 0;  ///< active cell index on its owner

    /// A node of the face that hangs, and what it follows: indices into ContactSurfaces::nodes(), and weights.
    struct Follower
    {
      unsigned int                                 n; ///< of the face
      std::vector<std::pair<unsigned int, double>> masters;
    };
    std::vector<Follower> hanging;
    /// Slave faces: numbers of the slave nodes whose basis functions are not zero on the face, ...
    std::vector<unsigned int> slaves;
    std::vector<double>       basis; ///< ... and these in the face's shape functions, [node][slave]; empty: the same

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

  /// Values and derivatives of the face shape functions at one point.
  struct FaceShape
  {
    unsigned int          n; ///< (degree+1)^2
    std::array<double, 9> value, d_xi, d_eta;
    FaceShape(unsigned int degree, double xi, double eta);
  };

  /// Position and tangents of a face at a shape point.
  struct FaceGeometry
  {
    Point   x;
    Vector3 d_xi, d_eta;
    FaceGeometry(const SurfaceFace &face, const FaceShape &shape, const std::vector<Point> &positions);
    /// @p points: as many positions as the shape has functions.
    FaceGeometry(const FaceShape &shape, const Point *points);
    /// x_xi x x_eta, length = surface element.
    Vector3 area_vector() const;
  };
} // namespace Nodus

#endif
