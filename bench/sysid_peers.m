% Fits the logs of sysid_starts from its start points with Octave's lsqcurvefit and a compiled simulator.
function sysid_peers(folder, count)
  warning('off', 'all');
  pkg load optim
  addpath(folder);
  t = {}; p = {}; y = [];
  for number = 1:3
    data = csvread(sprintf('%s/log%d.csv', folder, number), 1, 0);
    t{number} = data(:, 1); p{number} = data(:, 2); y = [y; data(:, 3)];
  end
  starts = load([folder '/starts.txt']);
  ours = load([folder '/ours.txt']);
  our_rmse = ours(1:end-1); per_start = ours(end) / numel(our_rmse);
  count = min(count, rows(starts));
  function answer = model(z, x)
    v = [z(1:4)(:); 325.9; exp(z(5:8)(:)); 0];
    answer = [simulate(t{1}, p{1}, v); simulate(t{2}, p{2}, v); simulate(t{3}, p{3}, v)];
  end
  lower = [0 0 -10 0 log(1e-9) * ones(1, 4)]'; upper = [10 10 10 10 log(1e9) * ones(1, 4)]';
  options = optimset('Display', 'off', 'MaxIter', 200);
  seconds = []; rmse = [];
  for i = 1:count
    z0 = [starts(i, 1:4) log(starts(i, 5:8))]';
    began = cputime();
    z = lsqcurvefit(@model, z0, 0, y, lower, upper, options);
    seconds(i) = cputime() - began;
    rmse(i) = sqrt(mean((model(z) - y) .^ 2));
  end
  printf('Octave lsqcurvefit: %.3f s of CPU per start, best RMSE %.6f mm\n', mean(seconds), min(rmse));
  better = sum(our_rmse(1:count)(:)' <= rmse * (1 + 1e-6));
  printf('  RMSE from the same start: softgrip''s is equal or lower in %d of %d\n', better, count);
  for i = 1:count
    printf('    softgrip %.6f mm   Octave %.6f mm in %.2f s\n', our_rmse(i), rmse(i), seconds(i));
  end
  printf('  ratio of CPU times of CPU per start, one thread each: %.0f\n', mean(seconds) / per_start);
end
