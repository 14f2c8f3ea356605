// proven_moves: The next value changes with the code only.
always @* if (code > 4'd1) proven_moves: assert (proven_next == proven);
