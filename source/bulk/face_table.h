#ifndef nodus_bulk_face_table_h
#define nodus_bulk_face_table_h

#include <nodus/base/types.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe.h>

#include <vector>

namespace Nodus
{
  /// Shape functions of some nodes of a cell at some points.
  struct ShapeTable
  {
    std::vector<unsigned int>        nodes; ///< of the scalar element
    std::vector<std::vector<double>> value; ///< [point][node]
  };

  /// Those of all nodes of the unit cell, at one point of it.
  struct PointTable : ShapeTable
  {
    PointTable(const dealii::FiniteElement<dim> &scalar_fe, const Point &point)
    {
      value.emplace_back();
      for (unsigned int a = 0; a < scalar_fe.n_dofs_per_cell(); ++a)
      {
        nodes.push_back(a);
        value.back().push_back(scalar_fe.shape_value(a, point));
      }
    }
  };

  /// Those of the nodes of one face of the unit cell, at the Gauss points of that face.
  struct FaceTable : ShapeTable
  {
    std::vector<Point>               points;
    std::vector<double>              weights;
    unsigned int                     direction[2]; ///< unit coordinates of two tangents, right-handed outwards
    std::vector<std::vector<double>> gradient[2];  ///< along the two tangents

    FaceTable(const dealii::FiniteElement<dim> &scalar_fe, const unsigned int face)
    {
      const dealii::QGauss<dim - 1> quadrature(scalar_fe.degree + 1);
      const unsigned int            normal = face / 2;
      const bool                    far    = face % 2 == 1;
      direction[0]                         = (normal + (far ? 1 : 2)) % dim;
      direction[1]                         = (normal + (far ? 2 : 1)) % dim;
      weights                              = quadrature.get_weights();
      for (unsigned int a = 0; a < scalar_fe.n_dofs_per_cell(); ++a)
        if (scalar_fe.has_support_on_face(a, face))
          nodes.push_back(a);
      for (const auto &on_face : quadrature.get_points())
      {
        Point point;
        point[normal]       = far;
        point[direction[0]] = on_face[0];
        point[direction[1]] = on_face[1];
        points.push_back(point);
        value.emplace_back();
        gradient[0].emplace_back();
        gradient[1].emplace_back();
        for (const auto a : nodes)
        {
          const auto unit_gradient = scalar_fe.shape_grad(a, point);
          value.back().push_back(scalar_fe.shape_value(a, point));
          for (unsigned int s = 0; s < 2; ++s)
            gradient[s].back().push_back(unit_gradient[direction[s]]);
        }
      }
    }
  };
} // namespace Nodus

#endif
