// The yardstick: the five-axle vehicle by hand, in vector registers.
//
// Average-acceleration Newmark as the implicit midpoint rule on (u, v): (2/h M + C + h/2 K) v_m = 2/h M v - K u + (F_n + F_n+1)/2,
// v <- 2 v_m - v, u <- u + h v_m. Axles are condensed out of the 8 x 8 system, the 3 x 3 rest is inverted once per individual.
// Sensor accelerations follow from equilibrium at kept samples.

#include <cstddef>
#include <thread>
#include <vector>

#ifdef __AVX512F__
constexpr int WIDTH = 8;
#else
constexpr int WIDTH = 4;
#endif
typedef double vec __attribute__((vector_size(WIDTH * sizeof(double))));

#ifndef GROUP
#define GROUP 2  // vectors that advance together, so that one fills the latency of the other
#endif
constexpr int LANES = WIDTH * GROUP;

struct Block {
  // Per axle: 2/h m, k + kt, k, kt, 1/A_ii, and the body's share of A, K and L for its travel row.
  vec mass[5], kk[5], k[5], kt[5], inv[5], share[5], rest[5], c[5];
  vec R1[5];
  vec B[6];        // inverse of the condensed 3 x 3
  vec mb[6], kb[6], cb[6];  // 2/h M, K, C of the bodies
  vec inverse_mass[6];
};

// Travel rows of the axles on the bodies are (1, r1, r2): r1 differs between individuals, r2 is measured.
static const double R2[5] = {0, 0, 0, 8.50, 9.73};

static inline void inverse3(const vec* a, vec* o) {
  vec c0 = a[3] * a[5] - a[4] * a[4], c1 = a[2] * a[4] - a[1] * a[5], c2 = a[1] * a[4] - a[2] * a[3];
  vec d = 1.0 / (a[0] * c0 + a[1] * c1 + a[2] * c2);
  o[0] = c0 * d; o[1] = c1 * d; o[2] = c2 * d;
  o[3] = (a[0] * a[5] - a[2] * a[2]) * d;
  o[4] = (a[1] * a[2] - a[0] * a[4]) * d;
  o[5] = (a[0] * a[3] - a[1] * a[1]) * d;
}

static inline void times3(const vec* s, vec x, vec y, vec z, vec& a, vec& b, vec& c) {
  a = s[0] * x + s[1] * y + s[2] * z;
  b = s[1] * x + s[3] * y + s[4] * z;
  c = s[2] * x + s[4] * y + s[5] * z;
}

// p: per individual mT mS IT IS, then m k c kt of five axles, then a1 a2 b1 b6.
static void setup(const double* p, long n, long first, int g, double h, Block& o) {
  auto read = [&](int row) {
    vec x;
    for (int l = 0; l < WIDTH; ++l) {
      long i = first + g * WIDTH + l;
      x[l] = p[row * n + (i < n ? i : n - 1)];
    }
    return x;
  };
  vec a1 = read(24), a2 = read(25), b1 = read(26), b6 = read(27), b7 = 3.75 - b1;
  o.R1[0] = -b1; o.R1[1] = 3.46 - b1; o.R1[2] = 4.80 - b1; o.R1[3] = o.R1[4] = b7;
  vec mT = read(0), mS = read(1), IT = read(2), IS = read(3), mu = mT * mS / (mT + mS);
  vec M[6] = {mT + mS, b7 * mS, b6 * mS, IT + b7 * b7 * mS + mu * a1 * a1, b6 * b7 * mS - mu * a1 * a2, IS + b6 * b6 * mS + mu * a2 * a2};
  inverse3(M, o.inverse_mass);
  vec A[6];
  for (int i = 0; i < 6; ++i) { o.mb[i] = 2 / h * M[i]; o.kb[i] = o.cb[i] = vec{}; A[i] = o.mb[i]; }
  for (int i = 0; i < 5; ++i) {
    vec m = read(4 + i), k = read(9 + i), c = read(14 + i), kt = read(19 + i);
    o.mass[i] = 2 / h * m; o.k[i] = k; o.kt[i] = kt; o.kk[i] = k + kt; o.c[i] = c;
    vec e = c + h / 2 * k;
    o.inv[i] = 1.0 / (o.mass[i] + e + h / 2 * kt);
    o.share[i] = e * o.inv[i];
    vec left = e - e * o.share[i];
    const vec r[3] = {vec{} + 1.0, o.R1[i], vec{} + R2[i]};
    int q = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++q) { o.kb[q] += r[a] * r[b] * k; o.cb[q] += r[a] * r[b] * c; A[q] += r[a] * r[b] * left; }
  }
  inverse3(A, o.B);
}

static void run_block(const double* p, long n, long first, const double* w, long steps, double h, long keep, double* out) {
  Block blocks[GROUP];
  vec u[GROUP][8] = {}, v[GROUP][8] = {};
  for (int g = 0; g < GROUP; ++g) setup(p, n, first, g, h, blocks[g]);
  const long kept = steps / keep + 1;
  for (long s = 0; s <= steps; ++s) {
    if (s % keep == 0) {
      for (int g = 0; g < GROUP; ++g) {
        const Block& o = blocks[g];
        vec f0, f1, f2, d0, d1, d2, a0, a1, a2;
        times3(o.kb, u[g][0], u[g][1], u[g][2], f0, f1, f2);
        times3(o.cb, v[g][0], v[g][1], v[g][2], d0, d1, d2);
        f0 = -f0 - d0; f1 = -f1 - d1; f2 = -f2 - d2;
        for (int i = 0; i < 5; ++i) {
          vec f = o.k[i] * u[g][3 + i] + o.c[i] * v[g][3 + i];
          f0 += f; f1 += o.R1[i] * f; f2 += R2[i] * f;
        }
        times3(o.inverse_mass, f0, f1, f2, a0, a1, a2);
        for (int j = 0; j < 2; ++j) {
          vec y = a0 + (j ? o.R1[3] : o.R1[0] - 0.29) * a1 + (j ? 9.32 : 0.0) * a2;
          for (int l = 0; l < WIDTH; ++l) {
            long i = first + g * WIDTH + l;
            if (i < n) out[(i * kept + s / keep) * 2 + j] = y[l];
          }
        }
      }
    }
    if (s == steps) break;
    double mean[5];
    for (int i = 0; i < 5; ++i) mean[i] = 0.5 * (w[5 * s + i] + w[5 * s + 5 + i]);
    for (int g = 0; g < GROUP; ++g) {
      const Block& o = blocks[g];
      vec *U = u[g], *V = v[g];
      vec f0, f1, f2, k0, k1, k2, r[5];
      times3(o.mb, V[0], V[1], V[2], f0, f1, f2);
      times3(o.kb, U[0], U[1], U[2], k0, k1, k2);
      f0 -= k0; f1 -= k1; f2 -= k2;
#pragma GCC unroll 5
      for (int i = 0; i < 5; ++i) {
        vec rise = U[0] + o.R1[i] * U[1];
        if (R2[i] != 0) rise += R2[i] * U[2];
        r[i] = o.mass[i] * V[3 + i] - o.kk[i] * U[3 + i] + o.k[i] * rise + o.kt[i] * mean[i];
        vec s1 = o.k[i] * U[3 + i] + o.share[i] * r[i];
        f0 += s1; f1 += o.R1[i] * s1;
        if (R2[i] != 0) f2 += R2[i] * s1;
      }
      vec m0, m1, m2;
      times3(o.B, f0, f1, f2, m0, m1, m2);
#pragma GCC unroll 5
      for (int i = 0; i < 5; ++i) {
        vec rate = m0 + o.R1[i] * m1;
        if (R2[i] != 0) rate += R2[i] * m2;
        vec m = o.inv[i] * r[i] + o.share[i] * rate;
        U[3 + i] += h * m; V[3 + i] = 2 * m - V[3 + i];
      }
      U[0] += h * m0; U[1] += h * m1; U[2] += h * m2;
      V[0] = 2 * m0 - V[0]; V[1] = 2 * m1 - V[1]; V[2] = 2 * m2 - V[2];
    }
  }
}

extern "C" void simulate(const double* p, long n, const double* w, long steps, double h, long keep, double* out, int threads) {
  long blocks = (n + LANES - 1) / LANES;
  auto work = [&](long start) {
    for (long b = start; b < blocks; b += threads) run_block(p, n, b * LANES, w, steps, h, keep, out);
  };
  if (threads <= 1) { work(0); return; }
  std::vector<std::thread> pool;
  for (int t = 0; t < threads; ++t) pool.emplace_back(work, t);
  for (auto& t : pool) t.join();
}
