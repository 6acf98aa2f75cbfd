#include "output/tables.h"
#include "base/complete_file.h"
#include "parallel/throw_everywhere.h"
#include <nodus/base/remedy.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    constexpr auto contact_header = "increment,time,pair,"
                                    "slave force x [force],slave force y [force],slave force z [force],"
                                    "slave moment x [force length],slave moment y [force length],"
                                    "slave moment z [force length],"
                                    "master force x [force],master force y [force],master force z [force],"
                                    "master moment x [force length],master moment y [force length],"
                                    "master moment z [force length],"
                                    "contact area [area],maximum pressure [pressure],"
                                    "open nodes,slip nodes,stick nodes,unpaired nodes,"
                                    "geometry passes,threshold passes,status passes,Newton iterations,"
                                    "Krylov iterations,status changes,tension,penetration,over cone,against slip,"
                                    "longest status cycle,fallbacks,cut-backs";

    constexpr auto master_header = "increment,time,pair,body,force x [force],force y [force],force z [force],"
                                   "moment x [force length],moment y [force length],moment z [force length]\n";

    constexpr auto reaction_header = "increment,time,condition,force x [force],force y [force],force z [force]\n";

    constexpr auto rigid_body_header = "increment,time,body,translation x [length],translation y [length],"
                                       "translation z [length],rotation x [degrees],rotation y [degrees],"
                                       "rotation z [degrees],force x [force],force y [force],force z [force],"
                                       "moment x [force length],moment y [force length],moment z [force length]\n";

    constexpr auto preload_header = "increment,time,pair,force [force],shortening [length],shear force x [force],"
                                    "shear force y [force],shear force z [force],locked\n";

    constexpr auto energy_header = "increment,time,external work [energy],released work [energy],contact work [energy],"
                                   "stored energy [energy],frictional dissipation [energy],"
                                   "plastic dissipation [energy],stabilisation [energy],imbalance [energy]\n";

    const std::string point_columns = "displacement x [length],displacement y [length],displacement z [length],"
                                      "stress xx [pressure],stress yy [pressure],stress zz [pressure],"
                                      "stress xy [pressure],stress xz [pressure],stress yz [pressure]\n";
    const std::string point_header  = "increment,time,point," + point_columns;
    const std::string line_header   = "increment,time,line,distance [length]," + point_columns;

    /// Imbalances below this part of the energies are round-off.
    constexpr double round_off = 1e-13;

    constexpr auto iteration_header = "increment,time,attempt,geometry pass,threshold pass,status pass,iteration,"
                                      "force residual,contact residual,Krylov iterations,statuses changed\n";

    /// Names come from the user and may hold commas: quoted, inner quotes doubled (RFC 4180).
    std::string quoted(const std::string &name)
    {
      std::string text = "\"";
      for (const char c : name)
        text += (c == '"' ? std::string("\"\"") : std::string(1, c));
      return text + '"';
    }

    std::ostringstream row()
    {
      std::ostringstream text;
      text.precision(12);
      return text;
    }

    void print(std::ostream &out, const Vector3 &v)
    {
      for (unsigned int d = 0; d < dim; ++d)
        out << ',' << v[d];
    }

    void print(std::ostream &out, const Tables::PointRow &point)
    {
      print(out, point.displacement);
      for (unsigned int i = 0; i < dealii::SymmetricTensor<2, dim>::n_independent_components; ++i)
        out << ',' << point.cauchy_stress.access_raw_entry(i);
      out << '\n';
    }

    /// Rows of a table that there may be none of.
    void add_optional(const std::string &header, const std::string &rows, std::string &table)
    {
      if (!rows.empty())
        table += (table.empty() ? header : "") + rows;
    }
  } // namespace

  Tables::Tables(const std::string &folder, MPI_Comm communicator, const std::vector<std::string> &bodies)
      : folder_(folder)
      , communicator_(communicator)
      , bodies_(bodies)
      , rows_{contact_header, reaction_header, energy_header, iteration_header, "", "", "", "", ""}
  {
    for (const char *name : remedy_names)
      rows_.contact += ',' + std::string(name);
    for (const char *name : measure_names)
      rows_.contact += ',' + std::string(name) + ',' + name + " tolerance";
    rows_.contact += '\n';
  }

  void Tables::add(const unsigned int                    increment,
                   const double                          t,
                   const std::vector<ContactResultants> &contact,
                   const std::vector<Reaction>          &reactions,
                   const std::vector<RigidBodyMotion>   &rigid_bodies,
                   const std::vector<PreloadSection>    &preloads,
                   const Energies                       &energies,
                   const IterationCounts                &counts,
                   const Verdict                        &verdict)
  {
    auto contact_rows = row();
    for (const auto &pair : contact)
    {
      contact_rows << increment << ',' << t << ',' << quoted(pair.name);
      for (const auto &v : {pair.slave_force, pair.slave_moment, pair.master_force, pair.master_moment})
        print(contact_rows, v);
      contact_rows << ',' << pair.contact_area << ',' << pair.maximum_pressure << ',' << pair.open << ',' << pair.slip
                   << ',' << pair.stick << ',' << pair.unpaired << ',' << counts.geometry << ',' << counts.threshold
                   << ',' << counts.status << ',' << counts.newton << ',' << counts.krylov << ','
                   << pair.status_changes;
      for (const unsigned int n : pair.contradictions)
        contact_rows << ',' << n;
      contact_rows << ',' << pair.longest_cycle << ',' << counts.fallbacks << ',' << counts.cut_backs;
      for (const unsigned int n : counts.remedies)
        contact_rows << ',' << n;
      for (const Verdict::Finding &finding : verdict)
        contact_rows << ',' << finding.value << ',' << finding.tolerance;
      contact_rows << '\n';
    }
    rows_.contact += contact_rows.str();

    auto master_rows = row();
    for (const auto &pair : contact)
      for (const auto &master : pair.masters)
      {
        master_rows << increment << ',' << t << ',' << quoted(pair.name) << ',' << quoted(bodies_[master.body - 1]);
        print(master_rows, master.force);
        print(master_rows, master.moment);
        master_rows << '\n';
      }
    add_optional(master_header, master_rows.str(), rows_.masters);

    auto reaction_rows = row();
    for (const auto &reaction : reactions)
    {
      reaction_rows << increment << ',' << t << ',' << quoted(reaction.name);
      print(reaction_rows, reaction.force);
      reaction_rows << '\n';
    }
    rows_.reactions += reaction_rows.str();

    auto rigid_rows = row();
    for (const RigidBodyMotion &body : rigid_bodies)
    {
      rigid_rows << increment << ',' << t << ',' << quoted(body.name);
      for (const Vector3 &v : {body.translation, 180. / dealii::numbers::PI * body.rotation, body.force, body.moment})
        print(rigid_rows, v);
      rigid_rows << '\n';
    }
    add_optional(rigid_body_header, rigid_rows.str(), rows_.rigid_bodies);

    auto preload_rows = row();
    for (const PreloadSection &section : preloads)
    {
      preload_rows << increment << ',' << t << ',' << quoted(section.name) << ',' << section.force << ','
                   << section.shortening;
      print(preload_rows, section.shear);
      preload_rows << ',' << section.locked << '\n';
    }
    add_optional(preload_header, preload_rows.str(), rows_.preloads);

    auto         energy_row = row();
    const double imbalance  = energies.imbalance();
    energy_row << increment << ',' << t << ',' << energies.external << ',' << energies.released << ','
               << energies.contact << ',' << energies.stored << ',' << energies.friction << ',' << energies.plastic
               << ',' << energies.stabilisation << ','
               << (std::abs(imbalance) > round_off * energies.throughput() ? imbalance : 0.) << '\n';
    rows_.energies += energy_row.str();
    finish_iterations();
    write();
  }

  void Tables::add_points(const unsigned int increment, const double t, const std::vector<PointRow> &points)
  {
    auto rows = row();
    for (const PointRow &point : points)
    {
      rows << increment << ',' << t << ',' << quoted(point.name);
      print(rows, point);
    }
    add_optional(point_header, rows.str(), rows_.points);
  }

  void Tables::add_lines(const unsigned int increment, const double t, const std::vector<PointRow> &points)
  {
    auto rows = row();
    for (const PointRow &point : points)
    {
      rows << increment << ',' << t << ',' << quoted(point.name) << ',' << point.distance;
      print(rows, point);
    }
    add_optional(line_header, rows.str(), rows_.lines);
  }

  void Tables::continue_from(const Rows &rows)
  {
    rows_ = rows;
    write();
  }

  void Tables::write() const
  {
    for (const auto &[name, rows] : {std::pair<const char *, const std::string *>{"contact.csv", &rows_.contact},
                                     {"masters.csv", &rows_.masters},
                                     {"reactions.csv", &rows_.reactions},
                                     {"rigid_bodies.csv", &rows_.rigid_bodies},
                                     {"preload.csv", &rows_.preloads},
                                     {"points.csv", &rows_.points},
                                     {"lines.csv", &rows_.lines},
                                     {"energy.csv", &rows_.energies},
                                     {"convergence.csv", &rows_.iterations}})
      if (!rows->empty())
        write(name, *rows);
  }

  void Tables::write(const std::string &name, const std::string &rows) const
  {
    std::string problem;
    if (dealii::Utilities::MPI::this_mpi_process(communicator_) == 0)
    {
      CompleteFile file(folder_, name);
      file.stream() << rows;
      problem = file.finish();
    }
    throw_everywhere<InputError>(problem, communicator_);
  }

  void Tables::add(const Iteration &iteration)
  {
    iterations_.push_back(iteration);
  }

  void Tables::add_status_changes(const unsigned int n)
  {
    iterations_.back().norms.changes += n;
  }

  void Tables::add_failure()
  {
    finish_iterations();
    write("convergence.csv", rows_.iterations);
  }

  void Tables::finish_iterations()
  {
    auto rows = row();
    for (const Iteration &i : iterations_)
      rows << i.increment << ',' << i.t << ',' << i.pass.fallbacks + 1 << ',' << i.pass.geometry << ','
           << i.pass.threshold << ',' << i.pass.status << ',' << i.iteration << ',' << i.norms.force << ','
           << i.norms.contact << ',' << i.krylov << ',' << i.norms.changes << '\n';
    rows_.iterations += rows.str();
    iterations_.clear();
  }
} // namespace Nodus
