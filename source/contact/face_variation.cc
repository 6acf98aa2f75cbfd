#include "contact/face_variation.h"

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>

// The integrals of a face and their derivatives, once it is known how the integration points move.

namespace Nodus
{
  FaceVariation::FaceVariation(const ContactGeometry                             &geometry,
                               const VariationSources                            &sources,
                               const AveragedJump::Face                          &face,
                               const std::vector<Point>                          &measure,
                               const bool                                         current,
                               const std::optional<ContactPairParameters::Normal> normals)
      : all_sources_(sources)
      , face_(face)
      , measure_(measure)
      , current_(current)
      , slave_(geometry.slave[face.pair])
      , master_(geometry.master[face.pair])
      , search_(geometry.search[face.pair])
      , rigid_(geometry.rigid[face.pair])
      , part_(face.dual_part())
      , plain_(part_ == 1. && slave_.face(face.face).basis.empty())
      , n_(slave_.face(face.face).nodes.size())
  {
    if (normals)
      normals_.emplace(geometry, sources, face.pair, face.face, *normals);
    number_nodes();
    const unsigned int m = slave_.face(face.face).slaves.size(), size = 3 * nodes_.size();
    n_columns_ = nodes_.size() + 7;
    first_     = plain_ ? (rigid_ != nullptr ? moved() : offset()) : 0;
    for (Matrix *const parts : {&phi_.parts, &hat_.parts, &part_weight_})
      parts->setZero(m, parts_.size());
    mass_.value.setZero(m, m);
    mass_.derivative.setZero(m * m, size);
    phi_.value.setZero(m, n_columns_);
    phi_.derivative.setZero(m * n_columns_, size);
    if (part_ < 1.)
    {
      hat_.value.setZero(m, n_columns_);
      hat_.derivative.setZero(m * n_columns_, size);
    }
    for (Matrix *const rate : {&d_coverage_.fraction, &d_coverage_.counted})
      rate->setZero(1, size);
    take_exact_areas();
    if (!face.points.empty())
      add_all_points();
    finish();
  }

  FaceVariation::Nodal FaceVariation::of_slaves(const std::array<double, 9> &nodal) const
  {
    const SurfaceFace &face   = slave_.face(face_.face);
    const auto         values = face.slave_values(nodal);
    return Eigen::Map<const Nodal>(values.data(), face.slaves.size());
  }

  void FaceVariation::number_nodes()
  {
    nodes_         = slave_.face(face_.face).nodes;
    const auto add = [&](const unsigned int node)
    {
      if (std::find(nodes_.begin() + n_, nodes_.end(), node) == nodes_.end())
        nodes_.push_back(node);
    };
    const auto add_moving = [&](const SurfaceGeometry &surface, const unsigned int f)
    {
      for (unsigned int i = 0; i < VariationSources::n_moving(surface, f); ++i)
        parts_.push_back(all_sources_.part(face_.pair, &surface == &master_, f, i));
    };
    add_moving(slave_, face_.face);
    if (rigid_ != nullptr && rigid_->carrier() != nullptr)
      for (const unsigned int node : rigid_->carrier()->nodes())
        add(node);
    for (const MortarPoint &point : face_.points)
      if (const unsigned int f = point.master.face;
          rigid_ == nullptr && std::find(master_faces_.begin(), master_faces_.end(), f) == master_faces_.end())
      {
        master_faces_.push_back(f);
        for (const unsigned int node : master_.face(f).nodes)
          add(node);
        add_moving(master_, f);
      }
  }

  void FaceVariation::number_local(const unsigned int master_face)
  {
    local_.place.clear();
    for (unsigned int i = 0; i < n_; ++i)
      local_.place.push_back(i);
    const auto add = [&](const unsigned int *const begin, const unsigned int number)
    {
      for (unsigned int i = 0; i < number; ++i)
        local_.place.push_back(std::find(nodes_.begin() + n_, nodes_.end(), begin[i]) - nodes_.begin());
    };
    local_.first_part = parts_.size();
    if (rigid_ != nullptr)
    {
      if (rigid_->carrier() != nullptr)
        add(rigid_->carrier()->nodes().data(), RigidCarrier::n_nodes);
    }
    else if (!master_faces_.empty())
    {
      add(master_.face(master_face).nodes.data(), n_);
      if (master_.smoothed())
        local_.first_part =
            std::find(parts_.begin(), parts_.end(), all_sources_.part(face_.pair, true, master_face, 0)) -
            parts_.begin();
    }
    local_.n_slave  = n_;
    local_.n_master = local_.place.size() - n_;
    batch_.n_points = 0;
  }

  void FaceVariation::add_vector_field(const unsigned int column, const Vector3 &value, const Vector3 *const d)
  {
    for (unsigned int c = 0; c < dim; ++c)
      batch_.fields.push_back({column + c, value[c], {d[0][c], d[1][c], d[2][c], d[3][c]}});
  }

  void FaceVariation::make_fields(const MortarPoint &point, const FaceShape &shape)
  {
    batch_.fields.clear();
    for (unsigned int b = 0; b < shape.n && !plain_; ++b)
      batch_.fields.push_back({b, shape.value[b], {shape.d_xi[b], shape.d_eta[b], 0., 0.}});
    if (!plain_)
      batch_.fields.push_back({area(), 1., {0., 0., 0., 0.}});
    Vector3 value, d[4]; // of the offset
    if (slave_.smoothed())
    {
      const FaceGeometry smooth = slave_.at(face_.face, point.xi, point.eta);
      const FaceGeometry facet(slave_.face(face_.face), shape, slave_.positions());
      value = smooth.x - facet.x;
      d[0]  = smooth.d_xi - facet.d_xi;
      d[1]  = smooth.d_eta - facet.d_eta;
    }
    if (rigid_ != nullptr)
      make_rigid_fields(point, value, d);
    else
      make_meshed_fields(point, value, d);
    if (rigid_ != nullptr || slave_.smoothed() || master_.smoothed())
      add_vector_field(offset(), value, d);
  }

  void FaceVariation::make_meshed_fields(const MortarPoint &point, Vector3 &offset, Vector3 *const d_offset)
  {
    const auto [f, xi, eta] = point.master;
    const FaceShape shape(master_.degree(), xi, eta);
    for (unsigned int b = 0; b < shape.n; ++b)
      batch_.fields.push_back(
          {weight(local_.place[local_.n_slave + b]), -shape.value[b], {0., 0., -shape.d_xi[b], -shape.d_eta[b]}});
    if (!master_.smoothed())
      return;
    const FaceGeometry smooth = master_.at(f, xi, eta);
    const FaceGeometry facet(master_.face(f), shape, master_.positions());
    offset -= smooth.x - facet.x;
    d_offset[2] = facet.d_xi - smooth.d_xi;
    d_offset[3] = facet.d_eta - smooth.d_eta;
  }

  void FaceVariation::make_rigid_fields(const MortarPoint &point, Vector3 &offset, Vector3 *const d_offset)
  {
    const RigidPoint closest = rigid_->closest(slave_.at(face_.face, point.xi, point.eta).x);
    if (const RigidCarrier *const carrier = rigid_->carrier())
    {
      const RigidCarrier::Weights weights = carrier->weights(closest.x);
      for (unsigned int b = 0; b < weights.size(); ++b)
        batch_.fields.push_back({weight(local_.place[local_.n_slave + b]),
                                 -weights[b],
                                 {0.,
                                  0.,
                                  -(carrier->gradients()[b] * closest.direction[0]),
                                  -(carrier->gradients()[b] * closest.direction[1])}});
      return;
    }
    const RigidPart part = rigid_->part(closest.x);
    Vector3         d_moved[4]; // the motion is linear in the point
    for (unsigned int i = 0; i < 2; ++i)
    {
      d_offset[2 + i] = -closest.direction[i];
      d_moved[2 + i]  = rigid_->part(closest.x + closest.direction[i]).moved - part.moved;
    }
    offset -= part.x;
    add_vector_field(moved(), part.moved, d_moved);
  }

  void FaceVariation::add_point(const MortarPoint &point, const Eigen::Ref<const AnyGradient> &gradient)
  {
    const FaceShape shape(slave_.degree(), point.xi, point.eta);
    const double    weight = point.weight * FaceGeometry(slave_.face(face_.face), shape, measure_).area_vector().norm();
    make_fields(point, shape);
    const Nodal        phi      = of_slaves(shape.value);
    const Nodal        d_phi[2] = {of_slaves(shape.d_xi), of_slaves(shape.d_eta)};
    const unsigned int m = phi.size(), n_mass = m * (m + 1) / 2,
                       n_rows = n_mass + (part_ < 1. ? 2 : 1) * m * batch_.fields.size();
    if (batch_.n_points == 0)
      batch_.coefficients.resize(n_rows, 0);
    // matrices keep their memory
    if (batch_.gradients.cols() != 3 * local_.size() || batch_.gradients.rows() < n_coordinates * (batch_.n_points + 1))
      batch_.gradients.conservativeResize(std::max<Eigen::Index>(2 * batch_.gradients.rows(), 64 * n_coordinates),
                                          3 * local_.size());
    if (batch_.coefficients.cols() < n_coordinates * (batch_.n_points + 1))
      batch_.coefficients.conservativeResize(
          n_rows, std::max<Eigen::Index>(2 * batch_.coefficients.cols(), 64 * n_coordinates));
    batch_.gradients.middleRows<n_coordinates>(n_coordinates * batch_.n_points) = gradient;

    for (unsigned int a = 0, row = 0; a < m; ++a)
      for (unsigned int c = 0; c <= a; ++c)
      {
        auto         coefficient = batch_.coefficients.block<1, n_coordinates>(row++, n_coordinates * batch_.n_points);
        const double product     = weight * phi[a] * phi[c];
        mass_.value(a, c) += product;
        if (c < a)
          mass_.value(c, a) += product;
        coefficient << product, weight * (d_phi[0][a] * phi[c] + phi[a] * d_phi[0][c]),
            weight * (d_phi[1][a] * phi[c] + phi[a] * d_phi[1][c]), 0., 0.;
      }
    add_products(phi, d_phi, weight, phi_.value, n_mass);
    add_parts(point, phi, weight, phi_.parts);
    if (part_ < 1. || normals_)
    {
      const auto [hat, d_xi, d_eta] = hats(point);
      const Nodal d_hat[2]          = {d_xi, d_eta};
      if (part_ < 1.)
      {
        add_products(hat, d_hat, weight, hat_.value, n_mass + m * batch_.fields.size());
        add_parts(point, hat, weight, hat_.parts);
      }
      if (normals_)
        add_normals(point, weight, hat, d_hat, gradient);
    }
    ++batch_.n_points;
  }

  void FaceVariation::add_products(
      const Nodal &test, const Nodal *const d_test, const double weight, Matrix &value, unsigned int row)
  {
    for (unsigned int a = 0; a < test.size(); ++a)
      for (const Field &f : batch_.fields)
      {
        const double t = weight * test[a];
        value(a, f.column) += t * f.value;
        batch_.coefficients.block<1, n_coordinates>(row++, n_coordinates * batch_.n_points) << t * f.value,
            t * f.d[0] + weight * d_test[0][a] * f.value, t * f.d[1] + weight * d_test[1][a] * f.value, t * f.d[2],
            t * f.d[3];
      }
  }

  /// Offsets follow their parts at fixed coordinates.
  void FaceVariation::add_parts(const MortarPoint &point, const Nodal &test, const double weight, Matrix &sum) const
  {
    const auto add =
        [&](const unsigned int first, const unsigned int n, const double sign, const double xi, const double eta)
    {
      if (n == 0)
        return;
      const auto value = SurfaceGeometry::offset_functions(xi, eta);
      for (unsigned int a = 0; a < test.size(); ++a)
        for (unsigned int i = 0; i < n; ++i)
          sum(a, first + i) += sign * weight * test[a] * value[i];
    };
    add(0, VariationSources::n_moving(slave_, face_.face), 1., point.xi, point.eta);
    if (rigid_ == nullptr)
      add(local_.first_part,
          VariationSources::n_moving(master_, point.master.face),
          -1.,
          point.master.xi,
          point.master.eta);
  }

  void FaceVariation::flush()
  {
    if (batch_.n_points == 0)
      return;
    const unsigned int n = n_coordinates * batch_.n_points, m = mass_.value.rows();
    batch_.product.noalias() = batch_.coefficients.leftCols(n) * batch_.gradients.topRows(n);
    const auto scatter       = [&](const unsigned int from, Matrix &to, const unsigned int row)
    {
      for (unsigned int l = 0; l < local_.size(); ++l)
        to.block<1, dim>(row, dim * local_.place[l]) += batch_.product.block<1, dim>(from, dim * l);
    };
    unsigned int from = 0;
    for (unsigned int a = 0; a < m; ++a)
      for (unsigned int c = 0; c <= a; ++c, ++from)
      {
        scatter(from, mass_.derivative, a * m + c);
        if (c < a)
          scatter(from, mass_.derivative, c * m + a);
      }
    for (Matrix *const to : {&phi_.derivative, &hat_.derivative})
      if (to == &phi_.derivative || part_ < 1.)
        for (unsigned int a = 0; a < m; ++a)
          for (const Field &f : batch_.fields)
            scatter(from++, *to, a * n_columns_ + f.column);
    batch_.n_points = 0;
  }

  void FaceVariation::take_exact_areas()
  {
    static const dealii::QGauss<2> gauss(4);
    const unsigned int             m = mass_.value.rows();
    exact_.value.setZero(m, 1);
    exact_.derivative.setZero(m, 3 * nodes_.size());
    number_local(master_faces_.empty() ? 0 : master_faces_[0]);
    for (unsigned int q = 0; q < gauss.size(); ++q)
    {
      const double    xi = gauss.point(q)[0], eta = gauss.point(q)[1];
      const FaceShape shape(slave_.degree(), xi, eta);
      const Nodal area = gauss.weight(q) * FaceGeometry(slave_.face(face_.face), shape, measure_).area_vector().norm() *
                         of_slaves(shape.value);
      exact_.value += area;
      const Row row = fixed_element_gradient(shape, xi, eta);
      for (unsigned int a = 0; a < m && current_; ++a)
        exact_.derivative.row(a).head(3 * local_.n_slave) += area[a] * row.head(3 * local_.n_slave);
    }
  }

  /// With C = M^-1 U, U being the integrals with phi, and H those with hats, a row is
  /// scale (part area C + (1 - part) H), the scale such that covered faces have their exact areas, times the part that
  /// the points count with.
  void FaceVariation::finish()
  {
    const unsigned int m = mass_.value.rows(), n = n_columns_ - first_;
    result_.setZero(m * n_columns_, 3 * nodes_.size());
    if (face_.coverage.counted < 1.)
    {
      exact_.derivative *= face_.coverage.counted;
      exact_.derivative.noalias() += exact_.value * d_coverage_.counted;
      exact_.value *= face_.coverage.counted;
    }
    if (face_.points.empty())
      return;
    if (part_ == 0.)
    {
      result_      = hat_.derivative;
      part_weight_ = hat_.parts;
      return;
    }
    const Eigen::LDLT<Eigen::MatrixXd> solver(mass_.value);
    const Matrix C = solver.solve(phi_.value), inverse = solver.solve(Eigen::MatrixXd::Identity(m, m)),
                 parts = inverse * phi_.parts; // of no columns without rigid carriers
    const auto rows    = [&](Matrix &matrix, const unsigned int a)
    { return matrix.middleRows(a * n_columns_ + first_, n); };
    // dC = M^-1 (dU - dM C)
    for (unsigned int a = 0; a < m; ++a)
      for (unsigned int c = 0; c < m; ++c)
        rows(phi_.derivative, a).noalias() -= C.row(c).tail(n).transpose() * mass_.derivative.row(a * m + c);
    for (unsigned int a = 0; a < m; ++a)
      for (unsigned int c = 0; c < m; ++c)
        rows(result_, a) += inverse(a, c) * rows(phi_.derivative, c);
    if (part_ < 1.)
    {
      finish_partly(C, parts);
      return;
    }
    for (unsigned int a = 0; a < m; ++a)
    {
      rows(result_, a) *= exact_.value(a, 0);
      rows(result_, a).noalias() += C.row(a).tail(n).transpose() * exact_.derivative.row(a);
      part_weight_.row(a) = exact_.value(a, 0) * parts.row(a);
      if (plain_)
        result_.row(a * n_columns_ + a) = exact_.derivative.row(a);
      result_.row(a * n_columns_ + area()) = exact_.derivative.row(a);
    }
  }

  void FaceVariation::finish_partly(const Matrix &C, const Matrix &parts)
  {
    const unsigned int m = mass_.value.rows();
    for (unsigned int a = 0; a < m; ++a)
    {
      // what finish() took off is put back, as C is 1 there
      const double total   = phi_.value(a, area());
      Matrix       d_total = phi_.derivative.row(a * n_columns_ + area());
      for (unsigned int c = 0; c < m; ++c)
        d_total += C(c, area()) * mass_.derivative.row(a * m + c);
      const Eigen::RowVectorXd sum  = part_ * total * C.row(a) + (1. - part_) * hat_.value.row(a);
      const Eigen::RowVectorXd side = total * C.row(a) - hat_.value.row(a);
      const Matrix             derivative =
          part_ * (total * result_.middleRows(a * n_columns_, n_columns_) + C.row(a).transpose() * d_total) +
          (1. - part_) * hat_.derivative.middleRows(a * n_columns_, n_columns_) +
          face_.dual_slope() * side.transpose() * d_coverage_.fraction;
      const double S = sum[area()], exact = face_.exact_part(), scale = 1. + exact * (exact_.value(a, 0) / S - 1.);
      const Matrix d_scale = face_.exact_slope() * (exact_.value(a, 0) / S - 1.) * d_coverage_.fraction +
                             exact / S * (exact_.derivative.row(a) - exact_.value(a, 0) / S * derivative.row(area()));
      result_.middleRows(a * n_columns_, n_columns_) = scale * derivative + sum.transpose() * d_scale;
      part_weight_.row(a) = scale * (part_ * total * parts.row(a) + (1. - part_) * hat_.parts.row(a));
    }
  }
} // namespace Nodus
