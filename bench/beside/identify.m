% Identifies the demo's finger with lsqcurvefit: identify(FOLDER, FIT, PREDICT...), 20 starts; needs simulate.mex in FOLDER.
function identify(folder, varargin)
  warning("off", "all");
  pkg load optim
  addpath(folder);
  for i = 1:numel(varargin)
    data = csvread(varargin{i}, 1, 0);
    t{i} = data(:, 1); p{i} = data(:, 2); y{i} = data(:, 3);
  end
  simulated = @(z, i) simulate(t{i}, p{i}, [z(1:4)(:); 325.9; exp(z(5:8)(:)); 0]);
  rmse = @(z, i) sqrt(mean((simulated(z, i) - y{i}) .^ 2));
  published = [0.07079; 0.17207; 0.02093; 0.02; log([18; 246.1; 2; 1.2])];
  lower = [0; 0; -10; 0; log(1e-9) * ones(4, 1)]; upper = [10; 10; 10; 10; log(1e9) * ones(4, 1)];
  options = optimset('Display', 'off', 'MaxIter', 300);
  rand('twister', 1);
  best = inf;
  for start = 1:20
    z0 = published;
    if start > 1
      z0 += [published(1:4) .* (1.2 * rand(4, 1) - 0.6); 2 * rand(4, 1) - 1];
    end
    [z, ~, residual, ~, ~, ~, jacobian] = lsqcurvefit(@(z, x) simulated(z, 1), z0, 0, y{1}, lower, upper, options);
    reached(start) = rmse(z, 1);
    if reached(start) < best
      best = reached(start); found = z; J = jacobian; r = residual;
    end
  end
  covariance = inv(J' * J) * sumsq(r) / (numel(r) - numel(found));
  held_out = arrayfun(@(i) rmse(found, i), 2:numel(varargin));
  printf('{"rmse_mm": %.12g, "held_out_rmse_mm": [%s], "reached": %d, "alpha": %.12g, "beta": %.12g, "beta_ci95": %.3g}\n', ...
         best, strjoin(arrayfun(@(v) sprintf('%.12g', v), held_out, 'UniformOutput', false), ', '), ...
         sum(reached < 1.001 * min(reached)), found(1), found(2), 1.96 * sqrt(covariance(2, 2)));
end
