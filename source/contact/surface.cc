#include <nodus/contact/face_rule.h>
#include <nodus/contact/surface.h>
#include <nodus/mesh/region.h>

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/trilinos_vector.h>

#include <algorithm>

namespace Nodus
{
  namespace
  {
    /// One face as sent to all ranks.
    struct FaceRecord
    {
      DoFIndex     dofs[9][dim];
      double       X[9][dim];
      double       orientation;
      unsigned int pair, side, rank, body;

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &dofs &X &orientation &pair &side &rank &body;
      }
    };
    constexpr unsigned int slave_side = 0, master_side = 1;

    void lagrange(const unsigned int degree, const double s, double value[3], double derivative[3])
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

    /// Faces of owned cells that lie in a region.
    void collect_faces(const Region                  &region,
                       const dealii::DoFHandler<dim> &dof_handler,
                       const dealii::Mapping<dim>    &mapping,
                       const unsigned int             pair,
                       const unsigned int             side,
                       std::vector<FaceRecord>       &records)
    {
      const auto        &fe             = dof_handler.get_fe();
      const auto        &base           = fe.base_element(0);
      const auto        &support_points = base.get_unit_support_points();
      const unsigned int n_1d           = fe.degree + 1;
      const unsigned int rank           = dealii::Utilities::MPI::this_mpi_process(dof_handler.get_communicator());

      std::vector<DoFIndex> cell_dofs(fe.n_dofs_per_cell());
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned() && cell->at_boundary())
          for (const unsigned int f : cell->face_indices())
            if (region.selects_face(mapping, cell, f))
            {
              cell->get_dof_indices(cell_dofs);
              const unsigned int normal = f / 2, a = normal == 0 ? 1 : 0, b = normal == 2 ? 1 : 2;
              FaceRecord         record{};
              // e_a x e_b = -e_normal for normal = y
              record.orientation = (normal == 1 ? -1. : 1.) * (f % 2 == 1 ? 1. : -1.);
              record.pair        = pair;
              record.side        = side;
              record.rank        = rank;
              record.body        = cell->material_id();
              for (unsigned int i = 0; i < base.n_dofs_per_cell(); ++i)
                if (std::abs(support_points[i][normal] - f % 2) < 1e-12)
                {
                  const auto position = [&](const unsigned int axis)
                  { return static_cast<unsigned int>(std::lround(support_points[i][axis] * fe.degree)); };
                  const unsigned int n = position(a) + n_1d * position(b);
                  const Point        X = mapping.transform_unit_to_real_cell(cell, support_points[i]);
                  for (unsigned int c = 0; c < dim; ++c)
                  {
                    record.dofs[n][c] = cell_dofs[fe.component_to_system_index(c, i)];
                    record.X[n][c]    = X[c];
                  }
                }
              records.push_back(record);
            }
    }

    std::string pair_label(const std::vector<ContactPairParameters> &pairs, const unsigned int pair)
    {
      return "Contact pair " + std::to_string(pair + 1) +
             (pairs[pair].name.empty() ? "" : " ('" + pairs[pair].name + "')");
    }
  } // namespace

  FaceShape::FaceShape(const unsigned int degree, const double xi, const double eta)
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

  FaceGeometry::FaceGeometry(const SurfaceFace &face, const FaceShape &shape, const std::vector<Point> &positions)
  {
    for (unsigned int n = 0; n < face.nodes.size(); ++n)
    {
      const Point &p = positions[face.nodes[n]];
      x += shape.value[n] * p;
      d_xi += shape.d_xi[n] * p;
      d_eta += shape.d_eta[n] * p;
    }
  }

  FaceGeometry::FaceGeometry(const FaceShape &shape, const Point *const points)
  {
    for (unsigned int n = 0; n < shape.n; ++n)
    {
      x += shape.value[n] * points[n];
      d_xi += shape.d_xi[n] * points[n];
      d_eta += shape.d_eta[n] * points[n];
    }
  }

  Vector3 FaceGeometry::area_vector() const
  {
    return dealii::cross_product_3d(d_xi, d_eta);
  }

  ContactSurfaces::ContactSurfaces(const std::vector<ContactPairParameters> &pairs,
                                   const Bodies                             &bodies,
                                   const dealii::DoFHandler<dim>            &dof_handler,
                                   const dealii::Mapping<dim>               &mapping)
      : degree_(dof_handler.get_fe().degree)
      , slave_faces_(pairs.size())
      , master_faces_(pairs.size())
      , face_size_(pairs.size(), 0.)
      , bodies_(pairs.size())
  {
    const MPI_Comm communicator = dof_handler.get_communicator();

    std::vector<FaceRecord> mine;
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      collect_faces(
          Region(pairs[p].slave, bodies, pair_label(pairs, p) + ", slave"), dof_handler, mapping, p, slave_side, mine);
      collect_faces(Region(pairs[p].master, bodies, pair_label(pairs, p) + ", master"),
                    dof_handler,
                    mapping,
                    p,
                    master_side,
                    mine);
    }
    std::vector<FaceRecord> records;
    for (const auto &part : dealii::Utilities::MPI::all_gather(communicator, mine))
      records.insert(records.end(), part.begin(), part.end());

    // Number the nodes by their first degree of freedom: ranks own ascending ranges, so slave nodes come out
    // contiguous per owner.
    const unsigned int    n_face_nodes = (degree_ + 1) * (degree_ + 1);
    std::vector<DoFIndex> first_dofs;
    first_dofs.reserve(records.size() * n_face_nodes);
    for (const auto &r : records)
      for (unsigned int n = 0; n < n_face_nodes; ++n)
        first_dofs.push_back(r.dofs[n][0]);
    std::sort(first_dofs.begin(), first_dofs.end());
    first_dofs.erase(std::unique(first_dofs.begin(), first_dofs.end()), first_dofs.end());

    const auto           &owned     = dof_handler.locally_owned_dofs();
    const DoFIndex        n_owned   = owned.n_elements();
    const auto            n_by_rank = dealii::Utilities::MPI::all_gather(communicator, n_owned);
    std::vector<DoFIndex> end_of_rank(n_by_rank.size());
    for (unsigned int r = 0; r < n_by_rank.size(); ++r)
      end_of_rank[r] = n_by_rank[r] + (r == 0 ? 0 : end_of_rank[r - 1]);

    nodes_.resize(first_dofs.size());
    fixed_.assign(nodes_.size(), {{false, false, false}});
    slave_number_.assign(nodes_.size(), dealii::numbers::invalid_unsigned_int);
    std::vector<unsigned int> slave_pair(nodes_.size(), dealii::numbers::invalid_unsigned_int);
    for (const auto &r : records)
    {
      SurfaceFace face;
      face.orientation = r.orientation;
      face.owner       = r.rank;
      for (unsigned int n = 0; n < n_face_nodes; ++n)
      {
        const unsigned int i =
            std::lower_bound(first_dofs.begin(), first_dofs.end(), r.dofs[n][0]) - first_dofs.begin();
        face.nodes.push_back(i);
        SurfaceNode &node = nodes_[i];
        for (unsigned int c = 0; c < dim; ++c)
        {
          node.dofs[c] = r.dofs[n][c];
          node.X[c]    = r.X[n][c];
        }
        node.owner = std::upper_bound(end_of_rank.begin(), end_of_rank.end(), r.dofs[n][0]) - end_of_rank.begin();
        if (r.side == slave_side)
        {
          if (slave_pair[i] != dealii::numbers::invalid_unsigned_int && slave_pair[i] != r.pair)
            throw InputError(
                pair_label(pairs, std::min(slave_pair[i], r.pair)) + " and " +
                pair_label(pairs, std::max(slave_pair[i], r.pair)) + " overlap: node (" + std::to_string(node.X[0]) +
                ", " + std::to_string(node.X[1]) + ", " + std::to_string(node.X[2]) +
                ") is slave in both; make the slave regions disjoint with 'Slave where' or join the pairs");
          slave_pair[i] = r.pair;
        }
      }
      bodies_[r.pair].insert(r.body);
      (r.side == slave_side ? slave_faces_ : master_faces_)[r.pair].push_back(std::move(face));
    }

    const std::vector<Point> X = positions(std::vector<Vector3>(nodes_.size()));
    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      for (const auto side : {slave_side, master_side})
        if ((side == slave_side ? slave_faces_ : master_faces_)[p].empty())
          throw InputError(pair_label(pairs, p) + ": the " + (side == slave_side ? "slave" : "master") +
                           " side has no face; check '" + (side == slave_side ? "Slave" : "Master") +
                           " boundary ids' and '" + (side == slave_side ? "Slave" : "Master") + " where'");
      for (const auto &face : master_faces_[p])
        if (std::all_of(face.nodes.begin(), face.nodes.end(), [&](const unsigned int i) { return slave_pair[i] == p; }))
          throw InputError(pair_label(pairs, p) +
                           ": a face is both slave and master; give the two sides different boundary ids or bodies");
      for (const auto &face : slave_faces_[p])
        face_size_[p] += std::sqrt(FaceGeometry(face, FaceShape(degree_, 0.5, 0.5), X).area_vector().norm());
      face_size_[p] /= slave_faces_[p].size();
    }

    for (unsigned int i = 0; i < nodes_.size(); ++i)
      if (slave_pair[i] != dealii::numbers::invalid_unsigned_int)
      {
        slave_number_[i] = slave_nodes_.size();
        slave_nodes_.push_back({i, slave_pair[i]});
      }

    for (unsigned int p = 0; p < pairs.size(); ++p)
    {
      has_points_.push_back(pairs[p].scheme == ContactPairParameters::Scheme::integration_point);
      if (!has_points_[p])
        continue;
      const dealii::Quadrature<2> rule = face_rule(pairs[p], degree_);
      for (unsigned int f = 0; f < slave_faces_[p].size(); ++f)
        for (unsigned int q = 0; q < rule.size(); ++q)
          slave_points_.push_back({p, f, rule.point(q)[0], rule.point(q)[1], rule.weight(q)});
    }

    const unsigned int rank  = dealii::Utilities::MPI::this_mpi_process(communicator);
    const auto         lower = [&](const unsigned int r)
    {
      return std::partition_point(slave_nodes_.begin(),
                                  slave_nodes_.end(),
                                  [&](const SlaveNode &s) { return nodes_[s.node].owner < r; }) -
             slave_nodes_.begin();
    };
    owned_range_ = {lower(rank), lower(rank + 1)};

    layout_.communicator  = communicator;
    layout_.n_u           = dof_handler.n_dofs();
    layout_.n_slave_nodes = slave_nodes_.size();
    for (unsigned int k = owned_range_.first; k < owned_range_.second; ++k)
      layout_.slave_nodes.push_back(nodes_[slave_nodes_[k].node].dofs[0] / dim);
    layout_.owned[0] = owned;
    layout_.owned[1].set_size(slave_nodes_.size());
    layout_.owned[1].add_range(owned_range_.first, owned_range_.second);
    layout_.owned[2].set_size(2 * slave_nodes_.size());
    layout_.owned[2].add_range(2 * owned_range_.first, 2 * owned_range_.second);

    surface_dofs_.set_size(dof_handler.n_dofs());
    std::vector<DoFIndex> all_dofs;
    for (const auto &node : nodes_)
      all_dofs.insert(all_dofs.end(), node.dofs.begin(), node.dofs.end());
    std::sort(all_dofs.begin(), all_dofs.end());
    surface_dofs_.add_indices(all_dofs.begin(), all_dofs.end());
    surface_dofs_.compress();
  }

  Point ContactSurfaces::site_position(const unsigned int site) const
  {
    if (!is_point(site))
      return nodes_[slave_nodes_[site].node].X;
    const SlavePoint &p = point(site);
    const FaceShape   shape(degree_, p.xi, p.eta);
    Point             X;
    for (unsigned int n = 0; n < shape.n; ++n)
      X += shape.value[n] * nodes_[slave_faces_[p.pair][p.face].nodes[n]].X;
    return X;
  }

  void ContactSurfaces::gather(const Vector &v, std::vector<Vector3> &nodal_values) const
  {
    Vector ghosted(layout_.owned[0], surface_dofs_, layout_.communicator);
    ghosted = v;
    nodal_values.resize(nodes_.size());
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        nodal_values[i][c] = ghosted(nodes_[i].dofs[c]);
  }

  void ContactSurfaces::set_fixed(const dealii::AffineConstraints<double> &constraints)
  {
    Vector mask(layout_.owned[0], layout_.communicator);
    for (const auto i : layout_.owned[0])
      if (constraints.is_constrained(i))
        mask(i) = 1.;
    mask.compress(dealii::VectorOperation::insert);
    std::vector<Vector3> nodal;
    gather(mask, nodal);
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        fixed_[i][c] = nodal[i][c] > 0.5;
  }

  std::vector<Point> ContactSurfaces::positions(const std::vector<Vector3> &u) const
  {
    std::vector<Point> x(nodes_.size());
    for (unsigned int i = 0; i < nodes_.size(); ++i)
      x[i] = nodes_[i].X + u[i];
    return x;
  }
} // namespace Nodus
