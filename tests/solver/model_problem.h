#ifndef nodus_tests_solver_model_problem_h
#define nodus_tests_solver_model_problem_h

#include "base/deal_ii_versions.h"
#include "bulk/cell_corners.h"
#include "solve/linear_solver.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>
#include <map>

/// Two elastic cubes, one on the other, meshes that do not match, and made-up contact statuses on the common face:
/// everything a contact Newton hands to its linear solver, without a contact module.
namespace ModelProblem
{
  using namespace Nodus;

  struct Options
  {
    unsigned int degree          = 1;
    unsigned int n_cells         = 4;  ///< per edge of the master; the slave has one more
    double       stiffness_ratio = 1.; ///< slave over master
    double       tilt            = 0.; ///< of both bodies about (1, 1, 0) [rad]: normals off the axes
    bool         friction        = true;
    double       threshold_range = 1.;    ///< largest over smallest mu lambda_s
    double       slip_norm       = 1.2;   ///< ||w|| of slipping nodes; below 1 the block of Lambda is indefinite
    double       unit            = 1.;    ///< Young's modulus, and all stresses with it
    bool         all_closed      = false; ///< every node sticks; otherwise one part each is open, slips and sticks
    bool         floating        = false; ///< the slave is held by contact alone, otherwise its top is clamped
    bool         consistent      = false; ///< multipliers coupled by the surface mass
    int          void_node       = -1;    ///< this slave node's lambda has neither couplings nor a diagonal
    int          duplicate_node  = -1;    ///< this slave node repeats the lambda row of node 0
    bool         buckles         = false; ///< a spring pushes in the middle of the master: not positive definite
  };

  class TwoCubes
  {
  public:
    BlockLayout        layout;
    LinearSystem       system;
    std::vector<Point> node_positions;
    CellCorners        corners;

    explicit TwoCubes(const Options &options)
        : options(options)
        , triangulation(MPI_COMM_WORLD)
        , fe(dealii::FE_Q<dim>(options.degree), dim)
        , dof_handler(triangulation)
    {
      make_mesh();
      dof_handler.distribute_dofs(fe);
      corners = cell_corners(dof_handler);
      assemble_bulk();
      if (options.buckles)
        add_pushing_spring();
      number_slave_nodes();
      system.layout = &layout;
      layout.reinit(system.rhs);
      assemble_contact();
    }

    DisplacementNodes nodes() const
    {
      return {node_positions, corners};
    }

  private:
    void make_mesh()
    {
      std::vector<dealii::Point<dim>>    vertices;
      std::vector<dealii::CellData<dim>> cells;
      dealii::SubCellData                boundary;
      for (unsigned int body = 0; body < 2; ++body)
      {
        dealii::Triangulation<dim> cube;
        dealii::GridGenerator::subdivided_hyper_rectangle(
            cube, std::vector<unsigned int>(dim, options.n_cells + body), Point(0, 0, body), Point(1, 1, 1. + body));
        auto [points, body_cells, unused] = dealii::GridTools::get_coarse_mesh_description(cube);
        for (auto cell : body_cells)
        {
          for (auto &v : cell.vertices)
            v += vertices.size();
          cell.material_id = body;
          cells.push_back(cell);
        }
        vertices.insert(vertices.end(), points.begin(), points.end());
      }
      triangulation.create_triangulation(vertices, cells, boundary);
    }

    Vector3 rotate(const Vector3 &x) const
    {
      const Vector3 axis({std::sqrt(.5), std::sqrt(.5), 0.});
      return std::cos(options.tilt) * x + std::sin(options.tilt) * dealii::cross_product_3d(axis, x) +
             (1. - std::cos(options.tilt)) * (axis * x) * axis;
    }

    /// Nine tenths of the diagonal of the node in the middle, which is more than its neighbours hold, along z.
    void add_pushing_spring()
    {
      for (unsigned int n = 0; n < node_positions.size(); ++n)
        if (node_positions[n].distance(Point(.5, .5, .5)) < 1e-6)
          system.bulk.add_to_diagonal(dim * n + 2, -.9 * system.bulk.diagonal(n)[8]);
    }

    void assemble_bulk()
    {
      layout.communicator = MPI_COMM_WORLD;
      layout.owned[0]     = dof_handler.locally_owned_dofs();
      layout.n_u          = dof_handler.n_dofs();
      const auto support  = support_points(dealii::MappingQ1<dim>(), dof_handler);
      constraints         = no_constraints(dof_handler);
      for (const auto &[i, x] : support)
        if (x[2] < 1e-6 || (!options.floating && x[2] > 2. - 1e-6))
          constraints.add_line(i);
      constraints.close();

      for (const auto i : layout.owned[0])
        if (i % dim == 0)
          node_positions.push_back(Point(rotate(support.at(i))));

      // The material is isotropic, so a tilted body has the stiffness of the straight one in turned components.
      dealii::Tensor<2, dim> Q;
      for (unsigned int c = 0; c < dim; ++c)
      {
        const Vector3 column = rotate(dealii::Point<dim>::unit_vector(c));
        for (unsigned int r = 0; r < dim; ++r)
          Q[r][c] = column[r];
      }
      const dealii::QGauss<dim>  quadrature(options.degree + 1);
      dealii::FEValues<dim>      values(fe, quadrature, dealii::update_gradients | dealii::update_JxW_values);
      const unsigned int         n = fe.n_dofs_per_cell();
      dealii::FullMatrix<double> matrix(n, n);
      std::vector<dealii::types::global_dof_index> dofs(n);

      // every rank integrates all cells around its nodes
      std::vector<DoFIndex> cell_nodes, ghosts;
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (touches_owned(cell, dofs))
          for (unsigned int a = 0; a < n / dim; ++a)
          {
            cell_nodes.push_back(dofs[dim * a] / dim);
            if (!layout.owned[0].is_element(dofs[dim * a]))
              ghosts.push_back(cell_nodes.back());
          }
      const auto                map = std::make_shared<NodeMap>(layout.owned[0], ghosts, MPI_COMM_WORLD);
      std::vector<unsigned int> local_nodes;
      std::vector<std::size_t>  cell_end;
      for (const DoFIndex node : cell_nodes)
      {
        local_nodes.push_back(map->local(node));
        if (local_nodes.size() % (n / dim) == 0)
          cell_end.push_back(local_nodes.size());
      }
      system.bulk.reinit(map, local_nodes, cell_end);

      for (const auto &cell : dof_handler.active_cell_iterators())
        if (touches_owned(cell, dofs))
        {
          values.reinit(cell);
          const double E = options.unit * (cell->material_id() == 1 ? options.stiffness_ratio : 1.), nu = .3;
          const double mu = E / (2. * (1. + nu)), lambda = E * nu / ((1. + nu) * (1. - 2. * nu));
          matrix = 0.;
          for (unsigned int q = 0; q < quadrature.size(); ++q)
            for (unsigned int i = 0; i < n; ++i)
              for (unsigned int j = 0; j < n; ++j)
              {
                const unsigned int a = fe.system_to_component_index(i).first, b = fe.system_to_component_index(j).first;
                const Vector3      gi = Q * values.shape_grad(i, q), gj = Q * values.shape_grad(j, q);
                matrix(i, j) +=
                    values.JxW(q) * (lambda * gi[a] * gj[b] + mu * gi[b] * gj[a] + (a == b ? mu * (gi * gj) : 0.));
              }
          for (unsigned int i = 0; i < n; ++i)
            for (unsigned int j = 0; j < n; ++j)
            {
              const bool free = !constraints.is_constrained(dofs[i]) && !constraints.is_constrained(dofs[j]);
              const auto here = system.bulk.position(map->local(dofs[i] / dim), map->local(dofs[j] / dim));
              if (here.stored() && !here.transposed() && (free || i == j))
                system.bulk.block(here.block())[dim * (i % dim) + j % dim] += matrix(i, j);
            }
        }
    }

    template <typename Cell>
    bool touches_owned(const Cell &cell, std::vector<DoFIndex> &dofs) const
    {
      if (cell->is_artificial())
        return false;
      cell->get_dof_indices(dofs);
      return std::any_of(dofs.begin(), dofs.end(), [&](const DoFIndex i) { return layout.owned[0].is_element(i); });
    }

    struct Node
    {
      double   x, y;
      DoFIndex dof; ///< of component 0; the others follow

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &x &y &dof;
      }
    };

    // Nodes of one body on z = 1, of all ranks in order.
    std::vector<Node> surface_nodes(const unsigned int body) const
    {
      std::map<DoFIndex, Node> nodes;
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned() && cell->material_id() == body)
          for (const unsigned int v : cell->vertex_indices())
            if (const DoFIndex i = cell->vertex_dof_index(v, 0);
                std::abs(cell->vertex(v)[2] - 1.) < 1e-6 && layout.owned[0].is_element(i))
              nodes[i] = {cell->vertex(v)[0], cell->vertex(v)[1], i};
      std::vector<Node> mine, all;
      for (const auto &node : nodes)
        mine.push_back(node.second);
      for (const auto &part : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, mine))
        all.insert(all.end(), part.begin(), part.end());
      return all;
    }

    void number_slave_nodes()
    {
      slave                = surface_nodes(1);
      master               = surface_nodes(0);
      layout.n_slave_nodes = slave.size();
      layout.owned[1]      = dealii::IndexSet(slave.size());
      layout.owned[2]      = dealii::IndexSet(2 * slave.size());
      for (unsigned int k = 0; k < slave.size(); ++k)
        if (layout.owned[0].is_element(slave[k].dof))
        {
          layout.slave_nodes.push_back(slave[k].dof / dim);
          layout.owned[1].add_index(k);
          layout.owned[2].add_range(2 * k, 2 * k + 2);
        }
    }

    // Coefficients of the nodes in the jump of slave node k (equal for the three components).
    std::vector<std::pair<DoFIndex, double>> jump(const Node &node) const
    {
      std::vector<std::pair<DoFIndex, double>> result = {{node.dof, 1.}};
      const double                             h      = 1. / options.n_cells;
      for (const Node &m : master)
        if (const double w =
                std::max(0., 1. - std::abs(m.x - node.x) / h) * std::max(0., 1. - std::abs(m.y - node.y) / h);
            w > 1e-10)
          result.emplace_back(m.dof, -w);
      return result;
    }

    ContactStatus status(const Node &node) const
    {
      if (options.all_closed)
        return ContactStatus::stick;
      if (node.x > .7)
        return ContactStatus::open;
      return node.y > .5 ? ContactStatus::slip : ContactStatus::stick;
    }

    void assemble_contact()
    {
      const Vector3 n = -rotate(Vector3({0, 0, 1})), t[2] = {rotate(Vector3({1, 0, 0})), rotate(Vector3({0, 1, 0}))};
      const double  h    = 1. / (options.n_cells + 1);
      const double  area = h * h;
      system.multiplier_scale.clear();
      for (const DoFIndex k : layout.owned[1])
      {
        const Node         &node      = slave[k];
        const ContactStatus s         = status(node);
        const double        threshold = options.unit * std::pow(options.threshold_range, -node.y); // -mu lambda_s
        // rho_n / threshold, with rho_n of the softer body
        const double h_tau         = options.unit * std::min(1., options.stiffness_ratio) / (threshold * h);
        const bool   with_friction = options.friction && s != ContactStatus::open;

        // The patch of node k: itself, or with consistent weights the closed nodes that its shape function meets.
        std::vector<std::pair<const Node *, double>> patch;
        for (const Node &other : slave)
          if (&other == &node || options.consistent)
          {
            const double dx = std::abs(other.x - node.x) / h, dy = std::abs(other.y - node.y) / h;
            const double w = (dx < .1 ? 2. / 3 : 1. / 6) * (dy < .1 ? 2. / 3 : 1. / 6);
            if (dx < 1.1 && dy < 1.1 && (status(other) == ContactStatus::open) == (s == ContactStatus::open))
              patch.emplace_back(&other, options.consistent ? w * area : area);
          }

        const auto couple = [&](const DoFIndex multiplier, const Vector3 &direction, const double factor)
        {
          for (const auto &[other, weight] : patch)
            for (const auto &[dof, coefficient] : jump(*other))
              for (unsigned int c = 0; c < dim; ++c)
                if (const double v = weight * factor * coefficient * direction[c]; v != 0.)
                {
                  system.contact.add(multiplier, dof + c, v);
                  system.contact.add(dof + c, multiplier, v);
                }
        };

        if (s == ContactStatus::open)
          for (const auto &[other, weight] : patch)
            system.contact.add(layout.lambda(k), layout.lambda(other - slave.data()), -weight / options.unit * h);
        else if (static_cast<int>(k) == options.duplicate_node)
        {
          for (const auto &[dof, coefficient] : jump(slave[0]))
            for (unsigned int c = 0; c < dim; ++c)
            {
              system.contact.add(layout.lambda(k), dof + c, -area * coefficient * n[c]);
              system.contact.add(dof + c, layout.lambda(k), -area * coefficient * n[c]);
            }
        }
        else if (static_cast<int>(k) != options.void_node)
          couple(layout.lambda(k), n, -1.);

        // Slip along w, in a direction that changes from node to node.
        const double  angle = 1. + 3. * node.x, norm_w = options.slip_norm;
        const Vector3 w = std::cos(angle) * t[0] + std::sin(angle) * t[1];
        for (unsigned int a = 0; a < 2; ++a)
          if (!with_friction)
            system.contact.add(layout.Lambda(k, a), layout.Lambda(k, a), -area);
          else if (s == ContactStatus::stick)
            couple(layout.Lambda(k, a), t[a], threshold);
          else
          {
            couple(layout.Lambda(k, a), (t[a] - (t[a] * w) * w) / norm_w, threshold);
            for (unsigned int b = 0; b < 2; ++b)
              system.contact.add(layout.Lambda(k, a),
                                 layout.Lambda(k, b),
                                 -area * threshold / h_tau *
                                     ((a == b) - ((a == b) - (t[a] * w) * (t[b] * w)) / norm_w));
          }
        if (with_friction && s == ContactStatus::slip)
          for (const auto &[i, ci] : jump(node))
            for (const auto &[j, cj] : jump(node))
              for (unsigned int a = 0; a < dim; ++a)
                for (unsigned int b = 0; b < dim; ++b)
                  system.contact.add(i + a,
                                     j + b,
                                     area * threshold * h_tau * ci * cj * ((a == b) - n[a] * n[b] - w[a] * w[b]) /
                                         norm_w);

        for (unsigned int a = 0; a < 3; ++a)
          system.multiplier_scale.push_back(a > 0 && with_friction ? options.unit / threshold : 1.);

        system.rhs.block(1)(k) = s == ContactStatus::open ? 0. : .01 * area * (1. + .2 * node.x);
        if (static_cast<int>(k) == options.void_node)
          system.rhs.block(1)(k) = 0.;
        for (unsigned int a = 0; a < 2; ++a)
          system.rhs.block(2)(2 * k + a) = with_friction ? area * threshold * .001 * (a + node.y) : 0.;
      }
      if (options.duplicate_node >= 0)
        for (const int k : {0, options.duplicate_node})
          if (layout.owned[1].is_element(k))
            system.rhs.block(1)(k) = .01 * area;
      // A load on the slave surface and on the free sides, so that no block of the right-hand side vanishes.
      for (const DoFIndex i : layout.owned[0])
        if (!constraints.is_constrained(i))
          system.rhs.block(0)(i) =
              options.unit * 1e-3 * area * std::sin(1. + node_positions[layout.owned[0].index_within_set(i) / dim][2]);
      system.rhs.compress(dealii::VectorOperation::insert);
    }

    const Options                                     options;
    dealii::parallel::distributed::Triangulation<dim> triangulation;
    const dealii::FESystem<dim>                       fe;
    dealii::DoFHandler<dim>                           dof_handler;
    dealii::AffineConstraints<double>                 constraints;
    std::vector<Node>                                 slave, master;
  };

  /// Norms of u, lambda / unit, Lambda: independent of the unit.
  inline std::array<double, 3> norms(const BlockVector &v, const Options &options)
  {
    return {{v.block(0).l2_norm(), v.block(1).l2_norm() / options.unit, v.block(2).l2_norm()}};
  }

  /// Largest of the three relative differences of the blocks.
  inline double difference(const BlockVector &a, const BlockVector &b)
  {
    double result = 0.;
    for (unsigned int i = 0; i < 3; ++i)
    {
      Vector d(a.block(i));
      d -= b.block(i);
      if (const double norm = b.block(i).l2_norm(); norm > 0.)
        result = std::max(result, d.l2_norm() / norm);
    }
    return result;
  }
} // namespace ModelProblem

#endif
