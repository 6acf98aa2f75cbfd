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

  void SiteVariation::add_face(const ContactSurfaces &surfaces,
                               const FaceVariation   &face,
                               const unsigned int     a,
                               const double           part)
  {
    const auto add = [&](const Eigen::Index row, const unsigned int of_face, const double factor)
    {
      const double *value = face.row(a, of_face);
      for (const unsigned int node : face.nodes())
        for (unsigned int c = 0, at = 3 * place_of_source_[node]; c < dim; ++c)
          rows_(row, at + c) += part * factor * *value++;
    };
    for (unsigned int b = 0; b < face.nodes().size(); ++b)
    {
      const unsigned int n = face.nodes()[b], of_face = face.weight(b);
      if (face.is_void(a, of_face))
        continue;
      surfaces.expand(n,
                      1.,
                      [&](const unsigned int free_node, const double share)
                      { add(place_of_node_[free_node], of_face, share); });
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
      double          size; ///< the share
      Vector3         arm;  ///< from the mean
      Eigen::Vector2d d;
    };
    Moments(const SiteVariation      &variation,
            const JumpOperator       &jump,
            const unsigned int        site,
            const Basis              &b,
            const std::vector<Point> &x)
    {
      Vector3 mean;
      for (const JumpOperator::Entry *e = jump.begin(site); e != jump.end(site); ++e)
        beside += e->unbalanced * x[e->node];
      for (const JumpOperator::Entry *e = jump.middle(site); e != jump.end(site); ++e)
      {
        entries.push_back({variation.place_of_node_[e->node], e->share, Vector3(x[e->node]), Eigen::Vector2d::Zero()});
        mean += e->share * x[e->node];
        sum += e->share;
      }
      mean /= sum;
      for (Entry &e : entries)
      {
        e.arm -= mean;
        e.d = Eigen::Vector2d(e.arm * b[0], e.arm * b[1]);
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
      inverse = axes * value.asDiagonal() * axes.transpose();
      slope   = inverse * shift;
    }
    /// Derivative of H with respect to an entry of the spread (00, 11, 01), times @p y.
    Eigen::Vector2d by_spread(const unsigned int k, const Eigen::Vector2d &y) const
    {
      Eigen::Matrix2d unit = Eigen::Matrix2d::Zero();
      unit(k == 1, k != 0) = 1.;
      unit(k != 0, k == 1) = 1.;
      return axes * divided.cwiseProduct(axes.transpose() * unit * axes) * (axes.transpose() * y);
    }
    Eigen::Matrix2d axes, divided, to_beside, inverse;
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

  void SiteVariation::vary_shares(const JumpOperator    &jump,
                                  const ContactSurfaces &surfaces,
                                  const unsigned int     site,
                                  const SurfaceGeometry &master,
                                  const Vector3         &normal)
  {
    const MomentBalance::Shares &shares = jump.shares(site);
    shares_.setZero(nodes_.size(), rows_.cols());
    for (const JumpOperator::Entry *e = jump.middle(site); e != jump.end(site); ++e)
    {
      const auto   row  = rows_.row(place_of_node_[e->node]);
      const double sign = e->unbalanced > 0. ? 1. : -1.;
      if (shares.weighted > 0.)
        shares_.row(place_of_node_[e->node]) += shares.weighted * sign * row;
      if (shares.around > 0. && !row.isZero(0.))
        master.for_nodes_around(e->node,
                                -normal,
                                [&](const unsigned int node, const double part)
                                {
                                  surfaces.expand(node,
                                                  shares.around * sign * part,
                                                  [&](const unsigned int free_node, const double factor)
                                                  {
                                                    // those around a node of an average that has no weight are missing
                                                    if (const unsigned int at = place_of_node_[free_node]; at != none)
                                                      shares_.row(at) += factor * row;
                                                  });
                                });
    }
  }

  void SiteVariation::vary_moments(const Basis              &b,
                                   const Eigen::Matrix3d    *d_b,
                                   const Moments            &moments,
                                   const std::vector<Point> &x)
  {
    const auto normals = rows_.middleRows<3>(normal());
    slopes_.setZero(n_rows, rows_.cols());
    for (unsigned int i = 0; i < 2; ++i)
    {
      const Eigen::RowVector3d t = eigen(b[i]);
      for (unsigned int e = 0; e < nodes_.size(); ++e)
      {
        slopes_.row(to_beside + i) += b[i] * x[nodes_[e]] * rows_.row(e);
        if (weight_[e] != 0.)
          slopes_.block<1, 3>(to_beside + i, 3 * place_of_source_[nodes_[e]]) += weight_[e] * t;
      }
      slopes_.row(to_beside + i) += eigen(moments.beside) * d_b[i] * normals;
    }
    Eigen::RowVector3d turned[3] = {Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero(), Eigen::RowVector3d::Zero()};
    for (const Moments::Entry &e : moments.entries)
    {
      const unsigned int column = 3 * place_of_source_[nodes_[e.node]];
      const auto         share  = shares_.row(e.node);
      for (unsigned int k = 0; k < 3; ++k)
      {
        const unsigned int i = k == 1 ? 1 : 0, j = k == 0 ? 0 : 1;
        slopes_.row(to_spread + k) += e.d[i] * e.d[j] * share;
        slopes_.block<1, 3>(to_spread + k, column) += e.size * (e.d[i] * eigen(b[j]) + e.d[j] * eigen(b[i]));
        turned[k] += e.size * eigen(e.arm) * (e.d[i] * d_b[j] + e.d[j] * d_b[i]);
      }
      for (unsigned int i = 0; i < 2; ++i)
      {
        slopes_.row(to_mean + i) += e.d[i] / moments.sum * share;
        slopes_.block<1, 3>(to_mean + i, column) += e.size / moments.sum * eigen(b[i]);
      }
    }
    for (unsigned int k = 0; k < 3; ++k)
      slopes_.row(to_spread + k) += turned[k] * normals;
  }

  void SiteVariation::vary_turns(
      const SitePairing &site, const Basis &b, const Eigen::Matrix3d *d_b, const Moments &moments, const Slope &slope)
  {
    const auto normals = rows_.middleRows<3>(normal());
    turns_.setZero(3 * moments.entries.size(), rows_.cols());
    for (unsigned int m = 0; m < moments.entries.size(); ++m)
    {
      const Moments::Entry &e    = moments.entries[m];
      auto                  turn = turns_.middleRows<3>(3 * m);
      const Eigen::Vector2d h    = slope.inverse * e.d;
      for (unsigned int i = 0; i < 2; ++i)
      {
        if (!site.tangent_free[i])
          continue;
        const auto row = slope.inverse.row(i);
        Matrix     d_h =
            eigen(e.arm) * (row[0] * d_b[0] + row[1] * d_b[1]) * normals - row * slopes_.middleRows<2>(to_mean);
        for (unsigned int k = 0; k < 3; ++k)
          d_h += slope.by_spread(k, e.d)[i] * slopes_.row(to_spread + k);
        d_h.middleCols<3>(3 * place_of_source_[nodes_[e.node]]) += row[0] * eigen(b[0]) + row[1] * eigen(b[1]);
        turn += eigen(b[i]).transpose() * (h[i] * shares_.row(e.node) + e.size * d_h);
        turn += e.size * h[i] * d_b[i] * normals;
      }
    }
  }

  void SiteVariation::balance(const JumpOperator       &jump,
                              const ContactSurfaces    &surfaces,
                              const unsigned int        number,
                              const SurfaceGeometry    &master,
                              const SitePairing        &site,
                              const std::vector<Point> &x)
  {
    for (const JumpOperator::Entry *e = jump.begin(number); e != jump.end(number); ++e)
      weight_[place_of_node_[e->node]] = e->unbalanced;
    const Basis           b = MomentBalance::basis(site);
    const Moments         moments(*this, jump, number, b, x);
    const Eigen::Vector2d beside(moments.beside * b[0], moments.beside * b[1]);
    const Slope           slope(moments.spread, jump.size(number), beside);
    // of the basis with respect to the normal; a turn about that changes nothing
    const Eigen::Matrix3d d_b[2]  = {-eigen(site.normal).transpose() * eigen(b[0]),
                                     -eigen(site.normal).transpose() * eigen(b[1])};
    const auto            normals = rows_.middleRows<3>(normal());

    vary_shares(jump, surfaces, number, master, site.normal);
    vary_moments(b, d_b, moments, x);

    if (jump.lever(number) != 0.)
      vary_turns(site, b, d_b, moments, slope);

    // of the slope
    Eigen::Matrix<double, 2, n_rows> to_slope = Eigen::Matrix<double, 2, n_rows>::Zero();
    to_slope.middleCols<2>(to_beside)         = slope.inverse * slope.to_beside;
    for (unsigned int k = 0; k < 3; ++k)
      to_slope.col(to_spread + k) = slope.by_spread(k, slope.shift);
    const Matrix d_slope = to_slope * slopes_;

    const Eigen::RowVectorXd with_mean = slope.slope.transpose() * slopes_.middleRows<2>(to_mean);
    const Eigen::RowVector3d along     = slope.slope[0] * eigen(b[0]) + slope.slope[1] * eigen(b[1]);
    const Eigen::Matrix3d    d_along   = slope.slope[0] * d_b[0] + slope.slope[1] * d_b[1];
    for (const Moments::Entry &e : moments.entries)
    {
      auto row_e = rows_.row(e.node);
      row_e -= e.d.dot(slope.slope) * shares_.row(e.node);
      row_e -= e.size * (e.d.transpose() * d_slope - with_mean + eigen(e.arm) * d_along * normals);
      row_e.segment<3>(3 * place_of_source_[nodes_[e.node]]) -= e.size * along;
    }
  }
} // namespace Nodus
