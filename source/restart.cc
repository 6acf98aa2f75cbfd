#include <nodus/contact_problem_implementation.h>
#include <nodus/output/complete_file.h>
#include <nodus/signals.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/cell_id.h>

#include <boost/crc.hpp>
#include <boost/serialization/map.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

// What a checkpoint holds: the state that commit() keeps, and what of the run is not in the parameters.

namespace Nodus
{
  namespace
  {
    /// Shared by all ranks.
    struct Common
    {
      std::map<std::string, std::string> model; ///< that the state belongs to
      LoadStepping                       path{LoadSteppingParameters()};
      double                             stiffness_scale = 0.;
      Energies                           energies;
      std::vector<RigidBodies::State>    rigid_bodies;
      Tables::Rows                       rows;
      VtuOutput::Series                  series;

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &model &path &stiffness_scale &energies &rigid_bodies &series;
        archive &rows.contact &rows.reactions &rows.energies &rows.iterations &rows.rigid_bodies;
      }
    };

    std::string checksum_of(const std::string &file)
    {
      std::ifstream      stream(file, std::ios::binary);
      boost::crc_32_type crc;
      char               buffer[65536];
      while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0)
        crc.process_bytes(buffer, stream.gcount());
      return std::to_string(crc.checksum());
    }

    /// Names and places of files may change, their contents may not.
    std::map<std::string, std::string> model_of(const Parameters &parameters)
    {
      std::map<std::string, std::string> model;
      for (const auto &[key, value] : parameters.model())
        if (const std::string last = key.substr(key.rfind('/') + 1); last != "Name")
          model[key] = last == "Mesh file" && !value.empty() ? "a file with checksum " + checksum_of(value) : value;
      return model;
    }

    std::string first_difference(const std::map<std::string, std::string> &then,
                                 const std::map<std::string, std::string> &now)
    {
      for (const auto &[key, value] : now)
        if (const auto before = then.find(key); before == then.end())
          return "'" + key + "' did not exist then";
        else if (before->second != value)
          return "'" + key + "' was '" + before->second + "' and is '" + value + "' now";
      for (const auto &[key, value] : then)
        if (now.count(key) == 0)
          return "'" + key + "' does not exist any more";
      return "";
    }

    std::string name_of(const int signal)
    {
      return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "signal " + std::to_string(signal);
    }

    constexpr unsigned int n_status = std::tuple_size<Status::Record>::value, n_site = n_status + dim;

    /// State of a slave node: that of the site, lambda, Lambda (two components, or a vector in space), the area that
    /// they refer to and the two tangents of the slip. It travels as vectors like the displacement, three numbers in
    /// each, zeros at the end.
    constexpr unsigned int n_node_vectors = (n_site + 5 + 2 * dim + dim - 1) / dim;
    /// Times that a mesh is refined at most on the way to that of a checkpoint.
    constexpr unsigned int largest_level_change = 30;
    /// Vectors of all nodes: displacement, reactions to be released, applied forces.
    constexpr unsigned int n_displacement_vectors = 3;
    using NodeState                               = std::array<double, dim * n_node_vectors>;

    SiteState site_state(const Status::Record &record, const Vector3 &force)
    {
      SiteState state;
      std::copy_n(force.begin_raw(), dim, std::copy(record.begin(), record.end(), state.begin()));
      return state;
    }

    using Cell = dealii::DoFHandler<dim>::active_cell_iterator;

    /// Whether two integration points lie on the same face.
    bool same_face(const ContactSurfaces &surfaces, const unsigned int a, const unsigned int b)
    {
      return surfaces.pair(a) == surfaces.pair(b) && surfaces.point(a).face == surfaces.point(b).face;
    }

    /// Names of this rank's slave faces with integration points, and of each the first of these among the sites.
    std::map<Checkpoints::Piece::FaceKey, unsigned int> faces_with_points(const ContactSurfaces         &surfaces,
                                                                          const dealii::DoFHandler<dim> &dof_handler)
    {
      std::map<unsigned int, std::vector<std::pair<std::set<DoFIndex>, unsigned int>>> first_point; // nodes; by cell
      for (unsigned int s = surfaces.n_sites(); s-- > surfaces.slave_nodes().size();)
        if (surfaces.is_owned(s) && (s == surfaces.slave_nodes().size() || !same_face(surfaces, s - 1, s)))
        {
          const SurfaceFace &face = surfaces.slave_faces(surfaces.pair(s))[surfaces.point(s).face];
          std::set<DoFIndex> nodes;
          for (const unsigned int n : face.nodes)
            nodes.insert(surfaces.nodes()[n].dofs[0]);
          first_point[face.cell].emplace_back(nodes, s);
        }
      std::map<Checkpoints::Piece::FaceKey, unsigned int> faces;
      if (first_point.empty())
        return faces;
      const auto           &fe = dof_handler.get_fe();
      std::vector<DoFIndex> dofs(fe.n_dofs_per_cell());
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (const auto found = first_point.find(cell->active_cell_index());
            cell->is_locally_owned() && found != first_point.end())
        {
          cell->get_dof_indices(dofs);
          for (const unsigned int face : cell->face_indices())
            for (const auto &[nodes, first] : found->second)
            {
              unsigned int shared = 0; // most, for hanging nodes may go by another number; faces share an edge at most
              for (unsigned int i = 0; i < dofs.size(); ++i)
                shared += fe.system_to_component_index(i).first == 0 && fe.has_support_on_face(i, face) &&
                          nodes.count(dofs[i]) == 1;
              if (2 * shared > nodes.size())
                faces[{cell->id().to_binary<dim>(), face}] = first;
            }
        }
      return faces;
    }

    /// Number of integration points on the face of point @p first.
    unsigned int n_points(const ContactSurfaces &surfaces, const unsigned int first)
    {
      unsigned int end = first;
      while (end < surfaces.n_sites() && same_face(surfaces, first, end))
        ++end;
      return end - first;
    }
  } // namespace

  /// Of the slave nodes; those of the integration point scheme have the mean of the points around them. Right at own
  /// nodes. Collective.
  std::vector<SiteState> ContactProblem::Implementation::node_states() const
  {
    std::vector<SiteState> states(surfaces->slave_nodes().size(), SiteState{});
    std::vector<double>    sums((n_site + 1) * states.size(), 0.);
    const unsigned int     rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    for (const ContactPoint &point : weights.points())
      if (point.site != dealii::numbers::invalid_unsigned_int && point.owner == rank)
      {
        const SiteState here = site_state(status->kept(point.site), committed_site_force[point.site]);
        for (unsigned int a = 0; a < point.slaves.size(); ++a)
        {
          double *const sum  = sums.data() + (n_site + 1) * point.slaves[a];
          const double  part = point.weight * std::abs(point.shape[a]);
          for (unsigned int i = 0; i < n_site; ++i)
            sum[i] += part * here[i];
          sum[n_site] += part;
        }
      }
    surfaces->slave_exchange().sum(sums, n_site + 1);
    for (unsigned int k = 0; k < states.size(); ++k)
      if (surfaces->has_status(k))
        states[k] = site_state(status->kept(k), committed_site_force[k]);
      else if (const double *const sum = sums.data() + (n_site + 1) * k; sum[n_site] > 0.)
        for (unsigned int i = 0; i < n_site; ++i)
          states[k][i] = sum[i] / sum[n_site];
    return states;
  }

  /// The states of integration points on a new mesh, from those of the slave nodes as nodal_state() has them.
  std::vector<SiteState> ContactProblem::Implementation::interpolated_sites(const std::vector<Vector> &vectors) const
  {
    std::vector<SiteState> sites(surfaces->n_sites(), SiteState{});
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
      for (unsigned int i = 0; i < n_site; ++i)
        sites[k][i] = vectors[n_displacement_vectors + i / dim](surfaces->nodes()[k].dofs[i % dim]);
    std::vector<SiteState> nodes(sites.begin(), sites.begin() + surfaces->slave_nodes().size());
    surfaces->slave_exchange().update(nodes);
    for (unsigned int s = nodes.size(); s < sites.size(); ++s)
    {
      const SlavePoint  &point = surfaces->point(s);
      const SurfaceFace &face  = surfaces->slave_faces(point.pair)[point.face];
      const auto         shape = face.slave_values(FaceShape(surfaces->degree(), point.xi, point.eta).value);
      for (unsigned int a = 0; a < face.slaves.size(); ++a)
        for (unsigned int i = 0; i < n_site; ++i)
          sites[s][i] += shape[a] * nodes[face.slaves[a]][i];
    }
    return sites;
  }

  /// The committed state as vectors like the displacement, which is the first of them: what a checkpoint and a new mesh
  /// take over. States of integration points are not among it. @p in_space: friction multipliers are vectors in space,
  /// to be interpolated; otherwise components, to be kept to the last digit.
  std::vector<Vector> ContactProblem::Implementation::nodal_state(const bool in_space) const
  {
    std::vector<Vector> vectors = {committed.block(0), reaction, committed_applied};
    for (unsigned int n = 0; n < n_node_vectors; ++n)
      vectors.emplace_back(surfaces->layout().owned[0], communicator);
    const std::vector<SiteState> means = in_space ? node_states() : std::vector<SiteState>();
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
    {
      NodeState       state{};
      const SiteState site       = in_space ? means[k] : site_state(status->kept(k), committed_site_force[k]);
      const DoFIndex  multiplier = surfaces->multiplier(k);
      double         *value      = std::copy(site.begin(), site.end(), state.begin());
      *value++                   = committed.block(1)(multiplier);
      Vector3 Lambda;
      for (unsigned int i = 0; i < 2; ++i)
        if (const double component = committed.block(2)(2 * multiplier + i); in_space)
          Lambda += component * committed_pairing[k].tangent[i];
        else
          Lambda[i] = component;
      value    = std::copy(Lambda.begin_raw(), Lambda.end_raw(), value);
      *value++ = committed_area.empty() ? 0. : committed_area[k];
      for (const Vector3 &tangent : committed_pairing[k].tangent)
        value = std::copy(tangent.begin_raw(), tangent.end_raw(), value);
      for (unsigned int i = 0; i < state.size(); ++i)
        vectors[n_displacement_vectors + i / dim](surfaces->nodes()[k].dofs[i % dim]) = state[i];
    }
    for (unsigned int n = 0; n < n_node_vectors; ++n)
      vectors[n_displacement_vectors + n].compress(dealii::VectorOperation::insert);
    return vectors;
  }

  /// Takes back what nodal_state() gave, and the states of integration points among @p sites (number of all sites).
  void ContactProblem::Implementation::set_nodal_state(const std::vector<Vector> &vectors,
                                                       const bool                 in_space,
                                                       std::vector<SiteState>     sites)
  {
    committed.block(0) = vectors[0];
    reaction           = vectors[1];
    committed_applied  = vectors[2];
    std::vector<std::array<Vector3, 2>> tangents(surfaces->n_sites());
    committed_area.assign(surfaces->slave_nodes().size(), 0.);
    for (unsigned int k = 0; k < surfaces->n_owned_slave_nodes(); ++k)
    {
      NodeState state;
      for (unsigned int i = 0; i < state.size(); ++i)
        state[i] = vectors[n_displacement_vectors + i / dim](surfaces->nodes()[k].dofs[i % dim]);
      if (!in_space || surfaces->has_status(k))
        std::copy_n(state.begin(), n_site, sites[k].begin());
      else
        sites[k] = SiteState{}; // the points have taken it over
      const double  *value           = state.data() + n_site;
      const DoFIndex multiplier      = surfaces->multiplier(k);
      committed.block(1)(multiplier) = *value++;
      Vector3 Lambda;
      for (unsigned int c = 0; c < dim; ++c)
        Lambda[c] = *value++;
      committed_area[k] = *value++;
      for (Vector3 &tangent : tangents[k])
        for (unsigned int c = 0; c < dim; ++c)
          tangent[c] = *value++;
      for (unsigned int i = 0; i < 2; ++i)
      {
        if (!in_space)
        {
          committed.block(2)(2 * multiplier + i) = Lambda[i];
          continue;
        }
        // on a new mesh the tangents lie between those of other nodes
        if (i == 1)
          tangents[k][1] -= (tangents[k][1] * tangents[k][0]) * tangents[k][0];
        if (const double norm = tangents[k][i].norm(); norm > 0.)
          tangents[k][i] /= norm;
        committed.block(2)(2 * multiplier + i) = Lambda * tangents[k][i];
      }
    }
    for (unsigned int b = 1; b < 3; ++b)
      committed.block(b).compress(dealii::VectorOperation::insert);
    const double largest =
        committed_area.empty() ? 0. : *std::max_element(committed_area.begin(), committed_area.end());
    if (dealii::Utilities::MPI::max(largest, communicator) == 0.)
      committed_area.clear(); // pressures on a mesh that has not seen equilibrium
    committed_pairing.set_tangents(tangents);
    std::vector<Status::Record> records(sites.size());
    for (unsigned int s = 0; s < sites.size(); ++s)
    {
      std::copy_n(sites[s].begin(), n_status, records[s].begin());
      std::copy_n(sites[s].begin() + n_status, dim, committed_site_force[s].begin_raw());
    }
    status->restore(records);
  }

  void ContactProblem::Implementation::write_checkpoint()
  {
    const auto timer = profile.time(Phase::output);
    Common     common{
        model_of(parameters), path, committed_stiffness_scale, energies, rigid_bodies->committed(), tables->rows(), {}};
    if (vtu)
      common.series = vtu->series();

    const std::vector<Vector> owned = nodal_state(false);
    std::vector<Vector>       relevant_vectors(owned.size());
    for (unsigned int n = 0; n < owned.size(); ++n)
    {
      relevant_vectors[n].reinit(surfaces->layout().owned[0], relevant, communicator);
      relevant_vectors[n] = owned[n];
    }

    Checkpoints::Piece               piece;
    std::vector<std::vector<double>> histories = solid->history();
    unsigned int                     n_cells   = 0;
    std::vector<DoFIndex>            dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        cell->get_dof_indices(dofs);
        std::vector<double> values;
        for (const Vector &v : relevant_vectors)
          for (const DoFIndex i : dofs)
            values.push_back(v(i));
        // only cells with slave nodes have the state of these; tangents are never zero
        const std::size_t n_always = n_displacement_vectors * dofs.size();
        if (std::all_of(values.begin() + n_always, values.end(), [](const double v) { return v == 0.; }))
          values.resize(n_always);
        piece.cells.emplace_back(cell->id().to_binary<dim>(), std::move(values));
        if (!histories[n_cells].empty())
          piece.histories.emplace_back(cell->id().to_binary<dim>(), std::move(histories[n_cells]));
        ++n_cells;
      }
    for (const auto &[face, first] : faces_with_points(*surfaces, dof_handler))
    {
      std::vector<double> values;
      for (unsigned int s = first; s < first + n_points(*surfaces, first); ++s)
      {
        const SiteState state = site_state(status->kept(s), committed_site_force[s]);
        values.insert(values.end(), state.begin(), state.end());
      }
      piece.faces.emplace_back(face, std::move(values));
    }
    checkpoints.write(path.increment() - 1, dealii::Utilities::pack(common), piece);
  }

  void ContactProblem::Implementation::read_checkpoint()
  {
    const auto timer = profile.time(Phase::set_up);
    const auto found = checkpoints.find();
    if (!found)
    {
      console.line("There is no checkpoint in " + parameters.output.results_folder + ": the run begins at t = 0");
      return;
    }
    if (!found->remark.empty())
      console.line("Passed over: " + found->remark);
    const Common      common = dealii::Utilities::unpack<Common>(found->common);
    const std::string other  = first_difference(common.model, model_of(parameters));
    throw_on_every_rank(other.empty() ? ""
                                      : "the checkpoint in " + parameters.output.results_folder +
                                            " belongs to another model: " + other +
                                            "; change it back, or begin without --restart in another Results folder",
                        communicator);
    path.continue_from(common.path);
    committed_stiffness_scale = common.stiffness_scale;
    energies                  = common.energies;
    rigid_bodies->restore(common.rigid_bodies);
    tables->continue_from(common.rows);
    if (vtu)
      vtu->continue_from(common.series);

    match_mesh(found->pieces);
    read_pieces(found->pieces);
    paired_before = true;
    roll_back();
    std::ostringstream text;
    text << "Continues after increment " << found->increment << ", t = " << path.time();
    console.line(text.str());
  }

  /// Refines and coarsens the mesh until its cells are those of the checkpoint.
  void ContactProblem::Implementation::match_mesh(const std::vector<std::filesystem::path> &pieces)
  {
    std::set<Checkpoints::Piece::CellKey> wanted;
    for (const auto &file : pieces)
      for (const auto &cell : Checkpoints::read(file).cells)
        wanted.insert(cell.first);
    auto &triangulation = bodies.triangulation();
    bool  changed       = false;
    for (unsigned int round = 0; round < largest_level_change; ++round)
    {
      unsigned int changes = 0;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned() && wanted.count(cell->id().to_binary<dim>()) == 0)
        {
          bool finer = false;
          for (auto coarser = Bodies::Triangulation::cell_iterator(cell); coarser->level() > 0 && !finer;)
          {
            coarser = coarser->parent();
            finer   = wanted.count(coarser->id().to_binary<dim>()) == 1;
          }
          if (finer)
            cell->set_coarsen_flag();
          else
            cell->set_refine_flag();
          ++changes;
        }
      if (dealii::Utilities::MPI::max(changes, communicator) == 0)
        break;
      triangulation.execute_coarsening_and_refinement();
      changed = true;
    }
    if (!changed)
      return;
    set_up_mesh();
    begin_on_mesh();
  }

  /// The committed state of this rank's cells, from whatever ranks wrote them.
  void ContactProblem::Implementation::read_pieces(const std::vector<std::filesystem::path> &pieces)
  {
    std::map<Checkpoints::Piece::CellKey, std::pair<Cell, std::size_t>> cells; // and the number of owned ones before
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const std::size_t n                = cells.size();
        cells[cell->id().to_binary<dim>()] = {cell, n};
      }
    std::vector<std::vector<double>> histories(cells.size());
    const auto                       faces = faces_with_points(*surfaces, dof_handler);

    std::vector<Vector> vectors(n_displacement_vectors + n_node_vectors,
                                Vector(surfaces->layout().owned[0], communicator));

    std::vector<SiteState> sites(surfaces->n_sites());
    std::vector<DoFIndex>  dofs(fe.n_dofs_per_cell());
    std::size_t            missing = cells.size() + faces.size();
    for (const auto &file : pieces)
    {
      const Checkpoints::Piece piece = Checkpoints::read(file);
      for (const auto &[key, values] : piece.cells)
        if (const auto cell = cells.find(key); cell != cells.end())
        {
          --missing;
          cell->second.first->get_dof_indices(dofs);
          for (unsigned int i = 0; i < values.size(); ++i)
            if (const DoFIndex dof = dofs[i % dofs.size()]; surfaces->layout().owned[0].is_element(dof))
              vectors[i / dofs.size()](dof) = values[i];
        }
      for (const auto &[key, values] : piece.histories)
        if (const auto cell = cells.find(key); cell != cells.end())
          histories[cell->second.second] = values;
      for (const auto &[key, values] : piece.faces)
        if (const auto face = faces.find(key); face != faces.end())
        {
          --missing;
          for (unsigned int i = 0; i < values.size(); ++i)
            sites[face->second + i / n_site][i % n_site] = values[i];
        }
    }
    throw_on_every_rank(missing == 0 ? "" : "the checkpoint does not cover the mesh; begin without --restart",
                        communicator);
    solid->set_history(histories);

    for (Vector &v : vectors)
      v.compress(dealii::VectorOperation::insert);
    set_nodal_state(vectors, false, std::move(sites));
  }

  /// Once per Newton iteration: writes a checkpoint of what converged last where a signal asks for it. @throws
  /// Interrupted where it asks for the end.
  void ContactProblem::Implementation::heed_signals()
  {
    const Signals::Request request = Signals::received(communicator);
    if (!request.checkpoint)
      return;
    const bool worthwhile = path.increment() > 1;
    if (worthwhile)
      write_checkpoint();
    if (request.end != 0)
    {
      std::ostringstream message;
      message << "ended by " << name_of(request.end) << " in increment " << path.increment();
      if (worthwhile)
        message << "; --restart continues from t = " << path.time();
      else
        message << ": nothing had converged";
      throw Interrupted(request.end, message.str());
    }
    console.remark(worthwhile ? "checkpoint written, as SIGUSR1 asked for" : "no checkpoint: nothing has converged");
  }
} // namespace Nodus
