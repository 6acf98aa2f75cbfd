#include "run/own_indicator.h"
#include "parallel/throw_everywhere.h"

#include <cmath>
#include <sstream>

namespace Nodus
{
  namespace
  {
    ErrorIndicator::Cell describe(const Model                                         &model,
                                  const dealii::DoFHandler<dim>::active_cell_iterator &cell,
                                  const std::vector<SolidAssembler::PointResult>      &points,
                                  const double                                         pressure)
    {
      const unsigned int   body = cell->material_id();
      ErrorIndicator::Cell result;
      double               volume = 0.;
      for (const auto &point : points)
      {
        volume += point.JxW;
        result.points.push_back({point.deformation_gradient,
                                 point.cauchy_stress,
                                 point.equivalent_plastic_strain,
                                 point.stored_energy,
                                 point.JxW});
      }
      result.centre           = cell->center();
      result.size             = std::cbrt(volume);
      result.body             = body + 1;
      result.level            = cell->level() - model.parameters.bodies[body].global_refinement;
      result.youngs_modulus   = model.materials[body]->youngs_modulus();
      result.contact_pressure = pressure;
      return result;
    }
  } // namespace

  bool ErrorIndicator::refine(const Cell & /*cell*/) const
  {
    return false;
  }

  void set_own_error(const Chosen<ErrorIndicator> &own,
                     const Model                  &model,
                     const Vector                 &u,
                     const std::vector<double>    &pressure,
                     RefinementIndicator          &indicator)
  {
    std::string problem;
    model.solid->visit(u,
                       [&](const auto &cell, const std::vector<SolidAssembler::PointResult> &points)
                       {
                         const unsigned int index = cell->active_cell_index();
                         if (model.materials[cell->material_id()]->is_rigid() || !problem.empty())
                           return;
                         try
                         {
                           const auto         situation = describe(model, cell, points, pressure[index]);
                           const double       error     = own.object->error(situation);
                           std::ostringstream text;
                           text << "is " << error << " in the cell at (" << situation.centre << "), and must be >= 0";
                           if (!(error >= 0.) || !std::isfinite(error))
                             problem = text.str();
                           indicator.squared_error[index] = error * error;
                           indicator.refine[index]        = own.object->refine(situation);
                         }
                         catch (const std::exception &error)
                         {
                           problem = std::string("fails: ") + error.what();
                         }
                       });
    throw_everywhere<InputError>(problem.empty() ? "" : "The indicator of refinement '" + own.name + "' " + problem,
                                 model.communicator);
    indicator.squared_norm = 1.;
  }
} // namespace Nodus
