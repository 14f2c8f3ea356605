"""What JSON Schema's own validator says of documents: one line for each, empty if it is content."""

import json
import sys

from jsonschema import Draft7Validator

given = json.load(sys.stdin)
Draft7Validator.check_schema(given["schema"])
validator = Draft7Validator(given["schema"])
for document in given["documents"]:
    errors = sorted(e.json_path + ": " + e.message.split("\n")[0] for e in validator.iter_errors(document))
    print("; ".join(errors))
