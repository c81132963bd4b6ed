"""Results so far, in a file from which a run can be resumed: one line of JSON each."""

import json
import os


class Results:
    """identity: what is compared. Results of another program, or another reference, are not resumed."""

    def __init__(self, path, identity, resume):
        self.path, self.results = path, {}
        path.parent.mkdir(parents=True, exist_ok=True)
        self.identity = self.resumed(identity) if resume and path.exists() else None
        if self.identity is None:
            self.identity = identity
            path.write_text(json.dumps(identity) + "\n")
        self.file = open(path, "a")

    def resumed(self, identity):
        """The identity in the file, and its results. Raises ValueError if the identity differs."""
        header, *lines = self.path.read_text().splitlines()
        header_values = json.loads(header)
        for key in ("program", "reference", "options", "forms"):
            if header_values.get(key) != identity[key]:
                raise ValueError(
                    f"can't resume {self.path}: its {key} was {header_values.get(key)}, this is {identity[key]}"
                )
        for line in lines:
            try:
                result = json.loads(line)
            except ValueError:
                break  # the last one, cut when the suite was stopped
            self.results[result["run"]] = result
        text = "".join(json.dumps(line) + "\n" for line in (header_values, *self.results.values()))
        temporary = self.path.with_suffix(".new")
        temporary.write_text(text)
        os.replace(temporary, self.path)
        return header_values

    def add(self, result):
        self.results[result["run"]] = result
        self.file.write(json.dumps(result) + "\n")
        self.file.flush()
