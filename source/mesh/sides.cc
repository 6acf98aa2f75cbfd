#include "mesh/sides.h"
#include "base/deal_ii_versions.h"
#include "parallel/all_gather.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace Nodus
{
  namespace
  {
    /// Mean normals of this length and more are those of flat sides, of the second length and less of closed ones.
    constexpr double flat = 0.9999, closed = 0.01;
  } // namespace

  Point without_round_off(Point p, const double size)
  {
    for (unsigned int c = 0; c < dim; ++c)
      if (std::abs(p[c]) < 1e-6 * size)
        p[c] = 0.;
    return p;
  }

  std::string coordinates(const Point &X)
  {
    std::ostringstream text;
    text << "(" << without_round_off(X, 1e-6 * X.norm()) << ")";
    return text.str();
  }

  std::string in_brackets(const std::string &name)
  {
    return name.empty() ? "" : " (" + name + ")";
  }

  std::string Side::text() const
  {
    const double       size = lower.distance(upper) + lower.norm() + upper.norm();
    std::ostringstream text;
    text.precision(4);
    text << n_faces << (n_faces == 1 ? " face" : " faces") << ", area " << area << ", from ("
         << without_round_off(lower, size) << ") to (" << without_round_off(upper, size) << "), ";
    if (normal.norm() < closed)
      text << "normals to all sides";
    else
    {
      text.precision(3);
      text << (normal.norm() > flat ? "normal (" : "curved, mean normal (")
           << without_round_off(Point(normal / normal.norm()), 1e3) << ')';
    }
    return text.str();
  }

  std::vector<std::map<dealii::types::boundary_id, Side>>
  sides_of(const Bodies &bodies, const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping)
  {
    const auto               &fe = dof_handler.get_fe();
    dealii::FEFaceValues<dim> values(
        mapping, fe, dealii::QGauss<dim - 1>(fe.degree + 1), dealii::update_JxW_values | dealii::update_normal_vectors);
    constexpr double                                        infinity = std::numeric_limits<double>::infinity();
    std::vector<std::map<dealii::types::boundary_id, Side>> sides(bodies.size());
    for (unsigned int b = 0; b < bodies.size(); ++b)
      for (const auto id : bodies.boundary_ids(b))
        for (unsigned int c = 0; c < dim; ++c)
        {
          sides[b][id].lower[c] = infinity;
          sides[b][id].upper[c] = -infinity;
        }
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
        {
          auto      &of_body = sides[cell->material_id()];
          const auto side    = of_body.find(cell->face(f)->boundary_id());
          if (!cell->at_boundary(f) || side == of_body.end())
            continue;
          ++side->second.n_faces;
          values.reinit(cell, f);
          for (const auto q : values.quadrature_point_indices())
          {
            side->second.area += values.JxW(q);
            side->second.normal += values.JxW(q) * values.normal_vector(q);
          }
          for (const unsigned int v : cell->face(f)->vertex_indices())
            for (unsigned int c = 0; c < dim; ++c)
            {
              side->second.lower[c] = std::min(side->second.lower[c], cell->face(f)->vertex(v)[c]);
              side->second.upper[c] = std::max(side->second.upper[c], cell->face(f)->vertex(v)[c]);
            }
        }
    const MPI_Comm communicator = communicator_of(dof_handler);
    for (auto &of_body : sides)
      for (auto &[id, side] : of_body)
      {
        side.n_faces = dealii::Utilities::MPI::sum(side.n_faces, communicator);
        side.area    = dealii::Utilities::MPI::sum(side.area, communicator);
        for (unsigned int c = 0; c < dim; ++c)
        {
          side.normal[c] = dealii::Utilities::MPI::sum(side.normal[c], communicator) / side.area;
          side.lower[c]  = dealii::Utilities::MPI::min(side.lower[c], communicator);
          side.upper[c]  = dealii::Utilities::MPI::max(side.upper[c], communicator);
        }
      }
    return sides;
  }

  Vector3
  mean_normal(const Region &region, const dealii::DoFHandler<dim> &dof_handler, const dealii::Mapping<dim> &mapping)
  {
    const auto               &fe = dof_handler.get_fe();
    dealii::FEFaceValues<dim> values(
        mapping, fe, dealii::QGauss<dim - 1>(fe.degree + 1), dealii::update_JxW_values | dealii::update_normal_vectors);
    Vector3 normal;
    double  area = 0.;
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f) && region.selects_face(mapping, cell, f))
          {
            values.reinit(cell, f);
            for (const auto q : values.quadrature_point_indices())
            {
              area += values.JxW(q);
              normal += values.JxW(q) * values.normal_vector(q);
            }
          }
    const MPI_Comm communicator = communicator_of(dof_handler);
    area                        = dealii::Utilities::MPI::sum(area, communicator);
    for (unsigned int c = 0; c < dim; ++c)
      normal[c] = dealii::Utilities::MPI::sum(normal[c], communicator) / area;
    return normal;
  }

  bool is_one_face_wide(const Region                  &region,
                        const dealii::DoFHandler<dim> &dof_handler,
                        const dealii::Mapping<dim>    &mapping)
  {
    using Edge = std::pair<DoFIndex, DoFIndex>;
    std::vector<Edge> edges; // of faces, by the degrees of freedom at their ends
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f) && region.selects_face(mapping, cell, f))
            for (const unsigned int line : cell->face(f)->line_indices())
            {
              const DoFIndex a = cell->face(f)->line(line)->vertex_dof_index(0, 0),
                             b = cell->face(f)->line(line)->vertex_dof_index(1, 0);
              edges.emplace_back(std::min(a, b), std::max(a, b));
            }
    std::map<Edge, unsigned int> faces_at;
    for (const auto &part : all_gather(communicator_of(dof_handler), edges))
      for (const Edge &edge : part)
        ++faces_at[edge];
    std::set<DoFIndex> rim;
    for (const auto &[edge, n] : faces_at)
      if (n == 1)
        rim.insert({edge.first, edge.second});
    return std::all_of(faces_at.begin(),
                       faces_at.end(),
                       [&](const auto &edge)
                       { return rim.count(edge.first.first) > 0 && rim.count(edge.first.second) > 0; });
  }
} // namespace Nodus
