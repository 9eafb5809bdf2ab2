"""What every campaign over worlds does: the worlds that are not known yet, some side by side, until all are done or the time
is up; and the command by which a page was made."""
import concurrent.futures
import time


def run(ledger, planned, run_world, told, workers, most_minutes):
    """Adds to the ledger what run_world(world) returns; told(world, result) is a line for the screen. No world is begun after
    `most_minutes` (None: all are run)."""
    until = time.monotonic() + 60 * most_minutes if most_minutes is not None else None
    left = iter([world for world in planned if world not in ledger])
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        running = {}

        def fill():
            while len(running) < workers and (until is None or time.monotonic() < until):
                world = next(left, None)
                if world is None:
                    break
                running[pool.submit(run_world, world)] = world

        fill()
        while running:
            done, _ = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
            for future in done:
                world, result = running.pop(future), future.result()
                ledger.add(result)
                print(f"{len(ledger.rows)}/{len(planned)} {told(world, result)}", flush=True)
            fill()


def command(script, parser, args, options):
    """The command line with those of `options` that are not the defaults, and the page."""
    line = f"{script} --work DIR"
    for option in options:
        value = getattr(args, option)
        if value != parser.get_default(option):
            words = value if isinstance(value, list) else [value]
            line += f" --{option.replace('_', '-')} {' '.join(f'{w:g}' if isinstance(w, float) else str(w) for w in words)}"
    return f"{line} --page {args.page}"
