// The yardstick: the five-axle vehicle by hand, in vector registers; a vector holds one quantity of several individuals.
//
// Average-acceleration Newmark is the implicit midpoint rule on displacement u and velocity v. Here it is rewritten, without approximation:
// with the body motion G of a step given at its upper end, an axle is a filter of third order, whose state can be kept in the form that
// needs fewest products (observer form). With alpha = 2/h, q the shift by one step, w the mean road of a step, f the force on the bodies:
//     a(q) = alpha^2 m (1-q)^2 + alpha c (1-q^2) + (k + kt) (1+q)^2,    s(q) = k (1+q) + alpha c (1-q),
//     f = -1/2 s(q) [alpha^2 m (1-q)^2 + kt (1+q)^2] / ((1-q) a(q)) G  +  kt (1+q) s(q) / a(q) w.
// f has a part that G makes at once (N0 G) and a part phi known before the step. The bodies, 3 coordinates: heave at axle 1, hinge, axle 4:
//     (alpha M - sum g N0 h g') V = r,   r_n+1 = r_n + sum g (phi_n+1 + phi_n + 2 N0 G_n),   G = h g V.
// Scales are free: phi / lambda (so that the road enters with factor 1), r (so that the 3 x 3 inverse has a unit diagonal), V (so that two
// axles need no product for their last state, and axle 5 none for its G). What is left: 51 products and 14 sums a step.
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#ifdef __AVX512F__
constexpr int WIDTH = 8;
#else
constexpr int WIDTH = 4;
#endif
typedef double vec __attribute__((vector_size(WIDTH * sizeof(double))));
#define INLINE static inline __attribute__((always_inline))

constexpr int AXLES = 5, SENSORS = 2, CHUNK = 64;

struct Axle {
  vec x1, x2, x3;  // observer states / lambda; x1 = phi, x3 = body's displacement at the axle, scaled
};
struct State {
  Axle axle[AXLES];
  vec r1, rh, r4;
};
struct AxleRow {
  vec a1, a2, b1, b2, b3, w;
};
struct Sensor {
  vec axle[AXLES][3], road[AXLES], r1, rh, r4;
};
struct Block {
  AxleRow axle[AXLES];
  vec i1h, i14, ih1, ih4, i41, i4h;                // the 3 x 3 inverse, beside its diagonal
  vec g2, g3;                                      // G of axles 2, 3 = hinge + g * axle 1
  vec q1, q2_1, q2_h, q3_1, q3_h, q4, q5_h, q5_4;  // an axle's force to r
  vec s11, s1h, sh1, shh, sh4, s4h, s44;           // the step's own body motion to r, through all axles
  Sensor sensor[SENSORS];
};
struct Matrix {
  vec v[3][3];
  const vec* operator[](int i) const { return v[i]; }
  vec* operator[](int i) { return v[i]; }
};

static Matrix inverse(const Matrix& a) {
  vec c0 = a[1][1] * a[2][2] - a[1][2] * a[1][2], c1 = a[0][2] * a[1][2] - a[0][1] * a[2][2], c2 = a[0][1] * a[1][2] - a[0][2] * a[1][1];
  vec d = 1.0 / (a[0][0] * c0 + a[0][1] * c1 + a[0][2] * c2), e = d * (a[0][1] * a[0][2] - a[0][0] * a[1][2]);
  return {{{c0 * d, c1 * d, c2 * d},
           {c1 * d, d * (a[0][0] * a[2][2] - a[0][2] * a[0][2]), e},
           {c2 * d, e, d * (a[0][0] * a[1][1] - a[0][1] * a[0][1])}}};
}

INLINE vec dot(const vec* a, const vec* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

INLINE void row_times(const vec* row, const Matrix& a, vec* out) {
  for (int j = 0; j < 3; ++j) out[j] = row[0] * a[0][j] + row[1] * a[1][j] + row[2] * a[2][j];
}

// p: per individual mT mS IT IS, then m k c kt of five axles (k > 0), then a1 a2 b1 b6.
static void setup(const double* p, long n, long first, double h, Block& o) {
  auto read = [&](int row) {
    vec x;
    for (int l = 0; l < WIDTH; ++l) x[l] = p[row * n + (first + l < n ? first + l : n - 1)];
    return x;
  };
  const vec one = 1.0 - vec{};
  const double alpha = 2.0 / h;
  vec mT = read(0), mS = read(1), a1 = read(24), a2 = read(25), b1 = read(26), b6 = read(27), b7 = 3.75 - b1, mu = mT * mS / (mT + mS);
  Matrix M = {{{mT + mS, b7 * mS, b6 * mS},
               {b7 * mS, read(2) + b7 * b7 * mS + mu * a1 * a1, b6 * b7 * mS - mu * a1 * a2},
               {b6 * mS, b6 * b7 * mS - mu * a1 * a2, read(3) + b6 * b6 * mS + mu * a2 * a2}}};
  // (z_T, theta_T, theta_S) = T (heave at axle 1, at the hinge, at axle 4)
  Matrix T = {{{b7 / 3.75, b1 / 3.75, {}}, {-one / 3.75, one / 3.75, {}}, {{}, -one / 8.50, one / 8.50}}}, MT = {}, mass = {};
  for (int i = 0; i < 3; ++i) row_times(M[i], T, MT[i]);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) mass[i][j] = T[0][i] * MT[0][j] + T[1][i] * MT[1][j] + T[2][i] * MT[2][j];
  const double y2 = 3.46 / 3.75, y3 = 4.80 / 3.75, y5 = 9.73 / 8.50;
  const vec zero = {};
  const vec g[AXLES][3] = {{one, zero, zero}, {one * (1 - y2), one * y2, zero}, {one * (1 - y3), one * y3, zero}, {zero, zero, one}, {zero, one * (1 - y5), one * y5}};

  vec lambda[AXLES], N0[AXLES], to[AXLES][3];
  Matrix S = {}, damping = {};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) S[i][j] = alpha * mass[i][j];
  for (int a = 0; a < AXLES; ++a) {
    vec m = alpha * alpha * read(4 + a), k = read(9 + a), damp = read(14 + a), c = alpha * damp, kt = read(19 + a), d = 1.0 / (m + c + k + kt);
    vec s0 = k + c, s1 = k - c, u0 = m + kt, u1 = 2.0 * (kt - m);
    AxleRow& o_a = o.axle[a];
    o_a.a1 = 2.0 * (m - k - kt) * d;
    o_a.a2 = (c - m - k - kt) * d;
    o_a.w = s1 / s0;
    lambda[a] = kt * s0 * d;
    N0[a] = -0.5 * s0 * u0 * d;
    vec N1 = -0.5 * (s0 * u1 + s1 * u0) * d, N3 = -0.5 * s1 * u0 * d;
    o_a.b1 = N1 + N0[a] * (1.0 + o_a.a1);
    o_a.b3 = -4.0 * k * kt * d;
    o_a.b2 = o_a.b3 - N3 + N0[a] * o_a.a2;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        S[i][j] -= h * N0[a] * g[a][i] * g[a][j];
        damping[i][j] += damp * g[a][i] * g[a][j];
      }
    // Back to (z, spring force / kt, 2/h m v / kt): rows of the transformation; the suspension's force / kt at a sample is to . (x1, x2, x3).
    vec share = s0 * d, k2 = k / kt, known = 2.0 * kt * d * (share * (m / kt - 1.0) + k2 * (1.0 - share));
    vec z2 = -share * (1.0 - o_a.a1) - known, F2 = (1.0 - share) * (1.0 - o_a.a1) - known, P2 = known - share * (1.0 + o_a.a1);
    vec e1 = k2 * (1.0 - share) - share, e2 = z2 + k2 * F2, det = 1.0 / (share * e2 - P2 * e1);
    to[a][0] = (c / m * e2 - P2 * k2) * det;
    to[a][1] = (share * k2 - e1 * c / m) * det;
    to[a][2] = (z2 * to[a][1] - share * to[a][0]) / (4.0 * k * d);
  }
  Matrix B = inverse(S);
  vec v1 = o.axle[0].b3 / lambda[0], v4 = o.axle[3].b3 / lambda[3], vh = v4 * ((1 - y5) / y5), V[3] = {v1, vh, v4};  // scales of V and r
  vec R[3] = {h * v1 * B[0][0], h * vh * B[1][1], h * v4 * B[2][2]};
  auto beside = [&](int i, int j) { return V[i] * B[i][j] / (V[j] * B[j][j]); };
  o.i1h = beside(0, 1), o.i14 = beside(0, 2), o.ih1 = beside(1, 0), o.ih4 = beside(1, 2), o.i41 = beside(2, 0), o.i4h = beside(2, 1);
  o.g2 = (1 - y2) / y2 * vh / v1, o.g3 = (1 - y3) / y3 * vh / v1;
  const vec unit[AXLES] = {1.0 / v1, y2 / vh, y3 / vh, 1.0 / v4, y5 / v4};
  vec own[AXLES];
  for (int a = 0; a < AXLES; ++a) {
    vec scale = unit[a] / lambda[a];
    own[a] = (o.axle[a].b1 + 2.0 * N0[a]) * scale;
    o.axle[a].b1 *= scale, o.axle[a].b2 *= scale, o.axle[a].b3 *= scale;
  }
  o.q1 = R[0] * lambda[0], o.q2_1 = R[0] * lambda[1] * g[1][0], o.q3_1 = R[0] * lambda[2] * g[2][0];
  o.q2_h = R[1] * lambda[1] * g[1][1], o.q3_h = R[1] * lambda[2] * g[2][1], o.q5_h = R[1] * lambda[4] * g[4][1];
  o.q4 = R[2] * lambda[3], o.q5_4 = R[2] * lambda[4] * g[4][2];
  o.s1h = o.q2_1 * own[1] + o.q3_1 * own[2], o.s11 = o.q1 * own[0] + o.q2_1 * own[1] * o.g2 + o.q3_1 * own[2] * o.g3;
  o.sh1 = o.q2_h * own[1] * o.g2 + o.q3_h * own[2] * o.g3, o.sh4 = o.q5_h * own[4], o.shh = o.q2_h * own[1] + o.q3_h * own[2] + o.sh4;
  o.s4h = o.q5_4 * own[4], o.s44 = o.q4 * own[3] + o.s4h;
  // Acceleration from equilibrium: M a = sum g (force with the body held) - damping V, V = inverse(alpha M) (r - sum g phi).
  Matrix inverse_mass = inverse(mass);
  const vec rows[SENSORS][3] = {{one, -(b1 + 0.29), zero}, {one, b7, 9.32 * one}};
  for (int j = 0; j < SENSORS; ++j) {
    Sensor& s = o.sensor[j];
    vec row[3], reaction[3], loss[3], lost[3];
    row_times(rows[j], T, row);
    row_times(row, inverse_mass, reaction);
    row_times(reaction, damping, lost);
    row_times(lost, inverse_mass, loss);
    s.r1 = -loss[0] / (alpha * R[0]), s.rh = -loss[1] / (alpha * R[1]), s.r4 = -loss[2] / (alpha * R[2]);
    for (int a = 0; a < AXLES; ++a) {
      vec lever = lambda[a] * dot(reaction, g[a]);
      for (int i = 0; i < 3; ++i) s.axle[a][i] = lever * to[a][i];
      s.road[a] = -s.axle[a][0] - s.axle[a][1] * o.axle[a].w;
      s.axle[a][0] += lambda[a] / alpha * dot(loss, g[a]);
    }
  }
}

// Returns what is known of phi_n+1 + phi_n before the body's motion; `unit` is an axle whose b3 is 1.
template <bool unit>
INLINE vec advance(Axle& s, const AxleRow& c, double road, vec G) {
  vec w = road - vec{}, x1 = c.a1 * s.x1 + (s.x2 + w), x2 = c.w * w + (c.a2 * s.x1 + s.x3), known = x1 + s.x1;
  s.x1 = c.b1 * G + x1;
  s.x2 = c.b2 * G + x2;
  s.x3 = unit ? s.x3 + G : c.b3 * G + s.x3;
  return known;
}

INLINE void step(State& s, const Block& c, const double* road) {
  vec v1 = c.i1h * s.rh + (c.i14 * s.r4 + s.r1), vh = s.rh + (c.ih1 * s.r1 + c.ih4 * s.r4), v4 = c.i4h * s.rh + (c.i41 * s.r1 + s.r4);
  vec f1 = advance<true>(s.axle[0], c.axle[0], road[0], v1), f4 = advance<true>(s.axle[3], c.axle[3], road[3], v4);
  vec f5 = advance<false>(s.axle[4], c.axle[4], road[4], v4 + vh);
  vec f2 = advance<false>(s.axle[1], c.axle[1], road[1], c.g2 * v1 + vh), f3 = advance<false>(s.axle[2], c.axle[2], road[2], c.g3 * v1 + vh);
  vec k1 = s.r1 + c.q1 * f1 + c.q2_1 * f2 + c.q3_1 * f3, k4 = s.r4 + c.q4 * f4 + c.q5_4 * f5;
  vec kh = s.rh + c.q5_h * f5 + c.q2_h * f2 + c.q3_h * f3;
  s.r1 = c.s1h * vh + (c.s11 * v1 + k1);
  s.r4 = c.s4h * vh + (c.s44 * v4 + k4);
  s.rh = c.shh * vh + (c.sh1 * v1 + (c.sh4 * v4 + kh));
}

INLINE vec acceleration(const State& s, const Sensor& c, const double* road) {
  vec sum = c.r1 * s.r1 + c.rh * s.rh + c.r4 * s.r4;
  for (int a = 0; a < AXLES; ++a)
    sum += c.axle[a][0] * s.axle[a].x1 + (c.axle[a][1] * s.axle[a].x2 + (c.axle[a][2] * s.axle[a].x3 + c.road[a] * road[a]));
  return sum;
}

// sums: w_n-1 + w_n before every step; means: w of the step that begins at a kept sample.
static void run_block(const double* p, long n, long first, const double* sums, const double* means, long kept, double h, long keep, double* out) {
  Block c;
  setup(p, n, first, h, c);
  State s = {};
  vec found[CHUNK][SENSORS];
  const long present = n - first < WIDTH ? n - first : WIDTH;
  for (long start = 0; start < kept; start += CHUNK) {
    const long samples = kept - start < CHUNK ? kept - start : CHUNK;
    for (long sample = 0; sample < samples; ++sample) {
      for (long i = start + sample ? 0 : keep - 1; i < keep; ++i, sums += AXLES) {
        asm volatile("" ::: "memory");  // constants are read where they are used, not copied to the stack before every loop
        step(s, c, sums);
      }
      for (int j = 0; j < SENSORS; ++j) found[sample][j] = acceleration(s, c.sensor[j], means + (start + sample) * AXLES);
    }
    for (long l = 0; l < present; ++l)
      for (long i = 0; i < samples * SENSORS; ++i) out[((first + l) * kept + start) * SENSORS + i] = found[i / SENSORS][i % SENSORS][l];
  }
}

extern "C" void simulate(const double* p, long n, const double* w, long steps, double h, long keep, double* out, int threads) {
  const long kept = steps / keep + 1, blocks = (n + WIDTH - 1) / WIDTH;
  std::vector<double> sums((steps + 1) * AXLES), means(kept * AXLES);
  for (long s = 0; s <= steps; ++s)
    for (int a = 0; a < AXLES; ++a) {
      const long at = s * AXLES + a;
      auto mean = [&](long i) { return 0.5 * (w[i] + w[i + AXLES]); };
      const double now = s < steps ? mean(at) : 0.0, before = s > 0 ? mean(at - AXLES) : 0.0;
      sums[at] = before + now;
      if (s % keep == 0) means[s / keep * AXLES + a] = now;
    }
  std::atomic<long> next{0};
  auto work = [&] {
    for (long b; (b = next++) < blocks;) run_block(p, n, b * WIDTH, sums.data(), means.data(), kept, h, keep, out);
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < threads; ++t) pool.emplace_back(work);
  work();
  for (auto& t : pool) t.join();
}
