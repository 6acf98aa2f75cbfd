#include "run/checkpointing.h"
#include "parallel/throw_everywhere.h"
#include "run/checkpointed_model.h"
#include "run/state_vectors.h"
#include <nodus/base/signals.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>
#include <deal.II/grid/cell_id.h>

#include <boost/serialization/map.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>

#include <algorithm>
#include <csignal>
#include <map>
#include <set>
#include <sstream>
#include <vector>

// A checkpoint holds the committed state, and what of the run is not in the parameters.

namespace Nodus
{
  namespace
  {
    /// Shared by all ranks.
    struct Common
    {
      std::map<std::string, std::string>           model;         ///< that the state belongs to
      std::vector<std::pair<unsigned int, double>> second_passes; ///< pairs that have one, and clearances [length]
      LoadStepping                                 path{LoadSteppingParameters()};
      std::vector<char>                            state; ///< common members of it
      Tables::Rows                                 rows;
      VtuOutput::Series                            series;

      template <typename Archive>
      void serialize(Archive &archive, const unsigned int)
      {
        archive &model &second_passes &path &state &series;
        archive &rows.contact &rows.reactions &rows.energies &rows.iterations &rows.masters &rows.rigid_bodies &rows
            .points &rows.lines &rows.preloads;
      }
    };

    std::string name_of(const int signal)
    {
      return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "signal " + std::to_string(signal);
    }

    /// Times that a mesh is refined at most on the way to that of a checkpoint.
    constexpr unsigned int largest_level_change = 30;
    using Cell                                  = dealii::DoFHandler<dim>::active_cell_iterator;

    /// The same whatever kind of triangulation holds the cell.
    Checkpoints::Piece::CellKey key_of(const Bodies &bodies, const Bodies::Triangulation::cell_iterator &cell)
    {
      Checkpoints::Piece::CellKey key = cell->id().to_binary<dim>();
      key[0]                          = bodies.coarse_cell(cell);
      return key;
    }

    /// Whether two integration points lie on the same face.
    bool same_face(const ContactSurfaces &surfaces, const unsigned int a, const unsigned int b)
    {
      return surfaces.pair(a) == surfaces.pair(b) && surfaces.point(a).face == surfaces.point(b).face;
    }

    /// Names of this rank's slave faces with integration points, and of each the first of these among the sites.
    std::map<Checkpoints::Piece::FaceKey, unsigned int>
    faces_with_points(const Bodies &bodies, const ContactSurfaces &surfaces, const dealii::DoFHandler<dim> &dof_handler)
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
                faces[{key_of(bodies, cell), face}] = first;
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

  Checkpointing::Checkpointing(
      Model &model, Journal &journal, States &states, Equilibrium &equilibrium, Results &results)
      : model_(model)
      , journal_(journal)
      , states_(states)
      , equilibrium_(equilibrium)
      , results_(results)
      , checkpoints_(model.parameters.output.results_folder, model.communicator)
  {
  }

  void Checkpointing::set_aside()
  {
    if (const std::string moved = checkpoints_.set_aside(); !moved.empty())
      journal_.console.line("Checkpoints of an earlier run are kept in " + moved +
                            " (to continue that run, name the folder checkpoints again)");
  }

  bool Checkpointing::exists()
  {
    return checkpoints_.find().has_value();
  }

  const std::map<std::string, std::string> &Checkpointing::keys()
  {
    if (keys_.empty())
      keys_ = checkpointed_model(model_.parameters);
    return keys_;
  }

  void Checkpointing::write(const LoadStepping &path)
  {
    const auto             timer    = journal_.profile.time(Phase::output);
    const ContactSurfaces &surfaces = model_.contact->surfaces();
    Common                 common{keys(), {}, path, pack_common(states_.committed), journal_.tables->rows(), {}};
    for (const ContactPairParameters &pair : model_.parameters.contact_pairs)
      if (pair.second_pass)
        common.second_passes.emplace_back(pair.second_pass->of, pair.second_pass->clearance);
    if (const VtuOutput *const vtu = results_.vtu())
      common.series = vtu->series();

    const std::vector<Vector> exact = exact_vectors(states_.committed, *model_.contact);
    std::vector<Vector>       vectors;
    vectors.reserve(exact.size()); // a copy would not have the ghosts
    for (const Vector &v : exact)
      vectors.push_back(model_.with_ghosts(v));

    Checkpoints::Piece               piece;
    std::vector<std::vector<double>> histories = model_.solid->history();
    unsigned int                     n_cells   = 0;
    std::vector<DoFIndex>            dofs(model_.fe.n_dofs_per_cell());
    for (const auto &cell : model_.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        cell->get_dof_indices(dofs);
        std::vector<double> values;
        for (const Vector &v : vectors)
          for (const DoFIndex i : dofs)
            values.push_back(v(i));
        // only cells with slave nodes have the state of these; tangents are never zero
        const std::size_t n_always = n_displacement_vectors() * dofs.size();
        if (std::all_of(values.begin() + n_always, values.end(), [](const double v) { return v == 0.; }))
          values.resize(n_always);
        piece.cells.emplace_back(key_of(model_.bodies, cell), std::move(values));
        if (!histories[n_cells].empty())
          piece.histories.emplace_back(key_of(model_.bodies, cell), std::move(histories[n_cells]));
        ++n_cells;
      }
    for (const auto &[face, first] : faces_with_points(model_.bodies, surfaces, model_.dof_handler))
    {
      std::vector<double> values;
      for (unsigned int s = first; s < first + n_points(surfaces, first); ++s)
      {
        const std::vector<double> of_site = site_values(states_.committed, s);
        values.insert(values.end(), of_site.begin(), of_site.end());
      }
      piece.faces.emplace_back(face, std::move(values));
    }
    checkpoints_.write(path.increment() - 1, dealii::Utilities::pack(common), piece);
  }

  void Checkpointing::read(LoadStepping &path)
  {
    const auto timer = journal_.profile.time(Phase::set_up);
    const auto found = checkpoints_.find();
    Assert(found, dealii::ExcInternalError()); // or there is no restart
    if (!found->remark.empty())
      journal_.console.line("Passed over: " + found->remark);
    const Common      common = dealii::Utilities::unpack<Common>(found->common);
    const std::string other  = first_difference(common.model, keys(), common.path.time());
    throw_everywhere<InputError>(other.empty()
                                     ? ""
                                     : "the checkpoint in " + model_.parameters.output.results_folder +
                                           " belongs to another model: " + other +
                                           "; change it back, or begin without --restart in another Results folder",
                                 model_.communicator);
    path.continue_from(common.path);
    model_.look_ahead(path.planned_times());
    if (!common.second_passes.empty())
    {
      model_.add_second_passes(common.second_passes, states_);
      equilibrium_.begin_on_mesh();
      results_.begin_on_mesh();
    }
    match_mesh(found->pieces);
    read_pieces(found->pieces);
    unpack_common(common.state, states_.now);
    states_.committed = states_.now;
    model_.roll_back(states_);

    // now that nothing can be refused any more
    journal_.tables->continue_from(common.rows);
    if (VtuOutput *const vtu = results_.vtu())
      vtu->continue_from(common.series);
    std::ostringstream text;
    text << "Continues after increment " << found->increment << ", t = " << path.time();
    journal_.console.line(text.str());
  }

  /// Refines and coarsens the mesh until its cells are those of the checkpoint.
  void Checkpointing::match_mesh(const std::vector<std::filesystem::path> &pieces)
  {
    std::set<Checkpoints::Piece::CellKey> wanted;
    for (const auto &file : pieces)
      for (const auto &cell : Checkpoints::read(file).cells)
        wanted.insert(cell.first);
    bool changed = false;
    for (unsigned int round = 0; round < largest_level_change; ++round)
    {
      unsigned int changes = 0;
      for (const auto &cell : model_.bodies.triangulation().active_cell_iterators())
        if (cell->is_locally_owned() && wanted.count(key_of(model_.bodies, cell)) == 0)
        {
          bool finer = false;
          for (auto coarser = Bodies::Triangulation::cell_iterator(cell); coarser->level() > 0 && !finer;)
          {
            coarser = coarser->parent();
            finer   = wanted.count(key_of(model_.bodies, coarser)) == 1;
          }
          if (finer)
            cell->set_coarsen_flag();
          else
            cell->set_refine_flag();
          ++changes;
        }
      if (dealii::Utilities::MPI::max(changes, model_.communicator) == 0)
        break;
      if (!model_.bodies.refinable())
        throw InputError("the checkpoint in " + model_.parameters.output.results_folder +
                         " is of a refined mesh, but this run is to refine none: keep 'Adaptivity/Interval' (more than "
                         "there are increments, and the mesh stays as it is)");
      model_.bodies.refinable()->execute_coarsening_and_refinement();
      changed = true;
    }
    if (!changed)
      return;
    model_.set_up_mesh(states_.now);
    equilibrium_.begin_on_mesh();
    results_.begin_on_mesh();
  }

  /// The state of this rank's cells, from whatever ranks wrote them.
  void Checkpointing::read_pieces(const std::vector<std::filesystem::path> &pieces)
  {
    const ContactSurfaces                                              &surfaces = model_.contact->surfaces();
    std::map<Checkpoints::Piece::CellKey, std::pair<Cell, std::size_t>> cells; // and the number of owned ones before
    for (const auto &cell : model_.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const std::size_t n                = cells.size();
        cells[key_of(model_.bodies, cell)] = {cell, n};
      }
    std::vector<std::vector<double>> histories(cells.size());
    const auto                       faces = faces_with_points(model_.bodies, surfaces, model_.dof_handler);

    std::vector<Vector>   vectors(n_state_vectors(surfaces), Vector(surfaces.layout().owned[0], model_.communicator));
    std::vector<double>   sites(n_site_values() * surfaces.n_sites(), 0.);
    std::vector<DoFIndex> dofs(model_.fe.n_dofs_per_cell());
    std::size_t           missing = cells.size() + faces.size();
    for (const auto &file : pieces)
    {
      const Checkpoints::Piece piece = Checkpoints::read(file);
      for (const auto &[key, values] : piece.cells)
        if (const auto cell = cells.find(key); cell != cells.end())
        {
          if (values.size() > vectors.size() * dofs.size())
            continue; // more pairs meet there
          --missing;
          cell->second.first->get_dof_indices(dofs);
          for (unsigned int i = 0; i < values.size(); ++i)
            if (const DoFIndex dof = dofs[i % dofs.size()]; surfaces.layout().owned[0].is_element(dof))
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
            sites[n_site_values() * face->second + i] = values[i];
        }
    }
    throw_everywhere<InputError>(missing == 0 ? "" : "the checkpoint does not cover the mesh; begin without --restart",
                                 model_.communicator);
    model_.solid->set_history(histories);

    for (Vector &v : vectors)
      v.compress(dealii::VectorOperation::insert);
    states_.now.history = model_.solid->start();
    take_exact(vectors, std::move(sites), *model_.contact, states_.now);
  }

  void Checkpointing::heed_signals(const LoadStepping &path)
  {
    const Signals::Request request = Signals::received(model_.communicator);
    if (!request.checkpoint)
      return;
    const bool worthwhile = path.increment() > 1;
    if (worthwhile)
      write(path);
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
    journal_.console.remark(worthwhile ? "checkpoint written, as SIGUSR1 asked for"
                                       : "no checkpoint: nothing has converged");
  }
} // namespace Nodus
