#include "contact/site_variation.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace Nodus
{
  namespace
  {
    constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    Eigen::RowVector3d eigen(const Vector3 &v)
    {
      return {v[0], v[1], v[2]};
    }
    Eigen::Matrix3d eigen(const dealii::Tensor<2, dim> &m)
    {
      Eigen::Matrix3d result;
      for (unsigned int i = 0; i < dim; ++i)
        result.row(i) = eigen(m[i]);
      return result;
    }
  } // namespace

  SiteVariation::SiteVariation(const unsigned int n_surface_nodes, const unsigned int n_sources)
      : place_of_node_(n_surface_nodes, none)
      , place_of_source_(n_sources, none)
  {
  }

  void SiteVariation::clear()
  {
    for (const unsigned int node : nodes_)
      place_of_node_[node] = none;
    for (const unsigned int source : columns_)
      place_of_source_[source] = none;
    nodes_.clear();
    columns_.clear();
  }

  unsigned int SiteVariation::node(const unsigned int surface_node)
  {
    unsigned int &place = place_of_node_[surface_node];
    if (place == none)
    {
      place = nodes_.size();
      nodes_.push_back(surface_node);
    }
    return place;
  }

  unsigned int SiteVariation::column(const unsigned int source)
  {
    unsigned int &place = place_of_source_[source];
    if (place == none)
    {
      place = columns_.size();
      columns_.push_back(source);
    }
    return place;
  }

  void SiteVariation::number(const ContactSurfaces &surfaces, const FaceVariation &face)
  {
    for (const unsigned int n : face.nodes())
      surfaces.expand(n, 1., [&](const unsigned int free_node, double) { node(free_node); });
    for (const unsigned int n : face.nodes())
      column(n);
  }

  void SiteVariation::allocate()
  {
    rows_.setZero(nodes_.size() + 10, 3 * columns_.size());
    weight_.assign(nodes_.size(), 0.);
  }

  void SiteVariation::add_face(const ContactSurfaces &surfaces, const FaceVariation &face, const unsigned int a)
  {
    const auto add = [&](const Eigen::Index row, const unsigned int of_face, const double factor)
    {
      const double *value = face.row(a, of_face);
      for (const unsigned int node : face.nodes())
        for (unsigned int c = 0, at = 3 * place_of_source_[node]; c < dim; ++c)
          rows_(row, at + c) += factor * *value++;
    };
    for (unsigned int b = 0; b < face.nodes().size(); ++b)
    {
      const unsigned int n = face.nodes()[b], of_face = face.weight(b);
      if (face.is_void(a, of_face))
        continue;
      surfaces.expand(n,
                      1.,
                      [&](const unsigned int free_node, const double part)
                      { add(place_of_node_[free_node], of_face, part); });
      for (unsigned int c = 0; c < dim; ++c) // of hanging nodes
        if (surfaces.nodes()[n].offset[c] != 0.)
          add(offset() + c, of_face, surfaces.nodes()[n].offset[c]);
    }
    add(area(), face.area(), 1.);
    for (unsigned int c = 0; c < dim; ++c)
    {
      add(offset() + c, face.offset() + c, 1.);
      if (!face.is_void(a, face.moved() + c))
        add(moved() + c, face.moved() + c, 1.);
    }
  }

  void SiteVariation::take_means(const AveragedJump::Row &row)
  {
    for (const auto *const entries : {&row.slave, &row.master})
      for (const AveragedJump::Entry &e : *entries)
        weight_[place_of_node_[e.node]] = e.weight;
    const auto mean = [&](const Eigen::Index i, const double value)
    { rows_.row(i) = (rows_.row(i) - value * rows_.row(area())) / row.area; };
    for (unsigned int e = 0; e < nodes_.size(); ++e)
      mean(e, weight_[e]);
    for (unsigned int c = 0; c < dim; ++c)
    {
      mean(offset() + c, row.offset[c] - row.rigid.x[c]);
      mean(moved() + c, row.rigid.moved[c]);
    }
  }

  /// What the balance knows of a row: mean and spread of its master nodes, in its tangents.
  struct SiteVariation::Moments
  {
    struct Entry
    {
      unsigned int    node; ///< of the row
      double          size, sign;
      Vector3         arm; ///< from the mean
      Eigen::Vector2d d;
    };
    Moments(const SiteVariation      &site,
            const SitePairing        &pairing,
            const AveragedJump::Row  &row,
            const std::vector<Point> &x)
    {
      Vector3 mean;
      for (const auto *const entries : {&row.slave, &row.master})
        for (const AveragedJump::Entry &e : *entries)
          beside += e.weight * x[e.node];
      for (const AveragedJump::Entry &e : row.master)
      {
        entries.push_back({site.place_of_node_[e.node],
                           std::abs(e.weight),
                           e.weight > 0. ? 1. : -1.,
                           Vector3(x[e.node]),
                           Eigen::Vector2d::Zero()});
        mean += std::abs(e.weight) * x[e.node];
        sum += std::abs(e.weight);
      }
      mean /= sum;
      for (Entry &e : entries)
      {
        e.arm -= mean;
        e.d = Eigen::Vector2d(e.arm * pairing.tangent[0], e.arm * pairing.tangent[1]);
        spread += e.size * e.d * e.d.transpose();
      }
    }
    std::vector<Entry> entries;
    Vector3            beside;
    double             sum    = 0.;
    Eigen::Matrix2d    spread = Eigen::Matrix2d::Zero();
  };

  /// slope = H(spread) shift, and its derivatives.
  struct SiteVariation::Slope
  {
    Slope(const Eigen::Matrix2d &spread, const double size, const Eigen::Vector2d &beside)
    {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
      axes = solver.eigenvectors();
      Eigen::Vector2d d_value;
      for (unsigned int i = 0; i < 2; ++i)
        std::tie(value[i], d_value[i]) = MomentBalance::inverse_of_spread(solver.eigenvalues()[i], size);
      const Eigen::Vector2d mu    = solver.eigenvalues();
      const double          apart = mu[1] - mu[0];
      divided << d_value[0], 0., 0., d_value[1];
      divided(0, 1) = divided(1, 0) =
          apart > 1e-6 * mu[1] ? (value[1] - value[0]) / apart : 0.5 * (d_value[0] + d_value[1]);

      const double length = beside.norm(), limit = MomentBalance::largest_shift * size;
      shift = beside;
      to_beside.setIdentity();
      if (length > limit)
      {
        shift     = limit / length * beside;
        to_beside = limit / length * (Eigen::Matrix2d::Identity() - beside * beside.transpose() / (length * length));
      }
      slope = axes * value.asDiagonal() * axes.transpose() * shift;
    }
    Eigen::Matrix2d axes, divided, to_beside;
    Eigen::Vector2d value, shift, slope;
  };

  namespace
  {
    /// Rows of the variations of beside, mean and spread (00, 11, 01).
    enum : Eigen::Index
    {
      to_beside = 0,
      to_mean   = 2,
      to_spread = 4,
      n_rows    = 7
    };
  } // namespace

  void SiteVariation::vary_moments(const SitePairing        &site,
                                   const Eigen::Matrix3d    *d_t,
                                   const Moments            &moments,
                                   const std::vector<Point> &x)
  {
    const auto normals = rows_.middleRows<3>(normal());
    slopes_.setZero(n_rows, rows_.cols());
    for (unsigned int i = 0; i < 2; ++i)
    {
      const Eigen::RowVector3d t = eigen(site.tangent[i]);
      for (unsigned int e = 0; e < nodes_.size(); ++e)
      {
        slopes_.row(to_beside + i) += site.tangent[i] * x[nodes_[e]] * rows_.row(e);
        if (weight_[e] != 0.)
          slopes_.block<1, 3>(to_beside + i, 3 * place_of_source_[nodes_[e]]) += weight_[e] * t;
      }
      slopes_.row(to_beside + i) += eigen(moments.beside) * d_t[i] * normals;
    }
    Eigen::RowVector3d turned[3] = {Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
    for (const Moments::Entry &e : moments.entries)
    {
      const unsigned int column = 3 * place_of_source_[nodes_[e.node]];
      const auto         row_e  = rows_.row(e.node);
      for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int i = k == 1 ? 1 : 0, j = k == 0 ? 0 : 1;
        slopes_.row(to_spread + k) += e.sign * e.d[i] * e.d[j] * row_e;
        slopes_.block<1, 3>(to_spread + k, column) +=
            e.size * (e.d[i] * eigen(site.tangent[j]) + e.d[j] * eigen(site.tangent[i]));
        turned[k] += e.size * eigen(e.arm) * (e.d[i] * d_t[j] + e.d[j] * d_t[i]);
      }
      for (unsigned int i = 0; i < 2; ++i)
      {
        slopes_.row(to_mean + i) += e.sign * e.d[i] / moments.sum * row_e;
        slopes_.block<1, 3>(to_mean + i, column) += e.size / moments.sum * eigen(site.tangent[i]);
      }
    }
    for (unsigned int k = 0; k < 3; ++k)
      slopes_.row(to_spread + k) += turned[k] * normals;
  }

  void SiteVariation::balance(const SitePairing            &site,
                              const std::array<Matrix3, 2> &turn,
                              const AveragedJump::Row      &row,
                              const std::vector<Point>     &x)
  {
    const Moments         moments(*this, site, row, x);
    const Eigen::Vector2d beside(moments.beside * site.tangent[0], moments.beside * site.tangent[1]);
    const Slope           slope(moments.spread, std::sqrt(row.whole), beside);
    const Eigen::Matrix3d d_t[2]  = {eigen(turn[0]), eigen(turn[1])};
    const auto            normals = rows_.middleRows<3>(normal());

    vary_moments(site, d_t, moments, x);

    // of the slope
    const Eigen::Matrix2d            H        = slope.axes * slope.value.asDiagonal() * slope.axes.transpose();
    const Eigen::Vector2d            s        = slope.axes.transpose() * slope.shift;
    Eigen::Matrix<double, 2, n_rows> to_slope = Eigen::Matrix<double, 2, n_rows>::Zero();
    to_slope.middleCols<2>(to_beside)         = H * slope.to_beside;
    for (unsigned int k = 0; k < 3; ++k)
    {
      Eigen::Matrix2d unit = Eigen::Matrix2d::Zero();
      unit(k == 1, k != 0) = 1.;
      unit(k != 0, k == 1) = 1.;
      to_slope.col(to_spread + k) =
          slope.axes * slope.divided.cwiseProduct(slope.axes.transpose() * unit * slope.axes) * s;
    }
    const Matrix d_slope = to_slope * slopes_;

    const Eigen::RowVectorXd with_mean = slope.slope.transpose() * slopes_.middleRows<2>(to_mean);
    const Eigen::RowVector3d along = slope.slope[0] * eigen(site.tangent[0]) + slope.slope[1] * eigen(site.tangent[1]);
    const Eigen::Matrix3d    d_along = slope.slope[0] * d_t[0] + slope.slope[1] * d_t[1];
    for (const Moments::Entry &e : moments.entries)
    {
      auto row_e = rows_.row(e.node);
      row_e *= 1. - e.sign * e.d.dot(slope.slope);
      row_e -= e.size * (e.d.transpose() * d_slope - with_mean + eigen(e.arm) * d_along * normals);
      row_e.segment<3>(3 * place_of_source_[nodes_[e.node]]) -= e.size * along;
    }
  }
} // namespace Nodus
