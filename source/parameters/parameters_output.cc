#include "parameters/body_names.h"
#include "parameters/output_fields.h"
#include "parameters/parameter_keys.h"

// The keys of what a run writes.

namespace Nodus
{
  namespace ParameterKeys
  {
    namespace
    {
      const Names<OutputParameters::Configuration> configuration_names = {
          {OutputParameters::Configuration::undeformed, "undeformed"},
          {OutputParameters::Configuration::deformed, "deformed"}};

      const Names<OutputParameters::NodalValues> nodal_values_names = {
          {OutputParameters::NodalValues::averaged, "averaged"}, {OutputParameters::NodalValues::by_cell, "by cell"}};

    } // namespace

    void add_output(ParameterHandler &prm, OutputParameters &output)
    {
      prm.add_parameter("Results folder",
                        output.results_folder,
                        "Folder of all results [-], relative to the working folder; empty: results/<name of the .prm "
                        "file>.",
                        Patterns::Anything());
      prm.add_parameter("Write VTU",
                        output.write_vtu,
                        "Whether fields are written [-]; false leaves the tables (a series of runs, measuring time).");
      prm.add_parameter(
          "VTU interval",
          output.vtu_interval,
          "Increments between two files of the fields [-], the first of which has the initial state; 0: the last "
          "increment only.",
          count);
      std::string names = "default|all";
      for (const OutputField &field : output_fields())
        names += '|' + std::string(field.name);
      prm.add_parameter("Fields",
                        output.fields,
                        "What VTU files have besides displacement, body or pair, node_id and cell_id [-]: names of "
                        "fields (see results.md), 'default' for the usual ones, 'all'.",
                        Patterns::List(Patterns::Selection(names), 0, Patterns::List::max_int_value, ","));
      add_choice(prm,
                 "Configuration",
                 output.configuration,
                 configuration_names,
                 "Where VTU files have the points of the bodies [-]: where they were at the start, to be warped by the "
                 "displacement, or where they are.");
      add_choice(prm,
                 "Nodal values",
                 output.nodal_values,
                 nodal_values_names,
                 "Stresses and strains in VTU files [-]: averaged over the cells around a node, or those of each cell, "
                 "which then has nodes of its own.");
      prm.add_parameter("Checkpoint interval",
                        output.checkpoint_interval,
                        "Increments between two checkpoints, from which --restart continues [-]; 0: only where a "
                        "signal asks for one (SIGUSR1, SIGTERM, SIGINT).",
                        count);
    }

    void add_output_point(ParameterHandler &prm, OutputPointParameters &point)
    {
      prm.add_parameter("Name", point.name, "Name in points.csv [-]; empty: point <n>.", Patterns::Anything());
      add_body(prm, "Body", point.body, point.body_name, "Number of the body, from 1, or its Name [-].");
      prm.add_parameter("Position",
                        point.position,
                        "Where the point is at the start [length]. It goes with the body; its displacement and stress "
                        "are written in every increment. A node, if it is at one.");
    }

    void add_output_line(ParameterHandler &prm, OutputLineParameters &line)
    {
      prm.add_parameter("Name", line.name, "Name in lines.csv [-]; empty: line <n>.", Patterns::Anything());
      add_body(prm, "Body", line.body, line.body_name, "Number of the body, from 1, or its Name [-].");
      prm.add_parameter("From", line.from, "Where the line begins at the start [length].");
      prm.add_parameter("To", line.to, "Where it ends at the start [length].");
      prm.add_parameter("Points",
                        line.points,
                        "Points at equal distances along it, with both ends [-]. They go with the body; their "
                        "displacements and stresses are written as often as VTU files.",
                        Patterns::Integer(2, 1000000));
    }
  } // namespace ParameterKeys
} // namespace Nodus
