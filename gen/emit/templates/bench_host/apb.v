    // The bus: an APB3 master. What it sets at a falling edge of the clock stands still at the rising one.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg psel, penable, pwrite;
    reg [12:0] paddr;
    reg [31:0] pwdata;
    wire [31:0] prdata;
    wire pready, pslverr;

    task host_idle;
        begin
            psel = 1'b0;
            penable = 1'b0;
            pwrite = 1'b0;
            paddr = 13'd0;
            pwdata = 32'd0;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(negedge clk);
            psel = 1'b1;
            pwrite = write;
            paddr = {address[10:0], 2'b00};
            pwdata = value;
            @(negedge clk);
            penable = 1'b1;
            for (k = 0; k < ACCESS_CYCLES_MAX && !pready; k = k + 1)
                @(negedge clk);
            check("pready", {47'd0, pready}, 48'd1);
            check("pslverr", {47'd0, pslverr}, 48'd0);
            answer = prdata;
            @(negedge clk);
            host_idle;
        end
    endtask

    // A transfer behind another one without a pause: psel stays.
    task follows(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            psel = 1'b1;
            penable = 1'b0;
            pwrite = write;
            paddr = {address[10:0], 2'b00};
            pwdata = value;
            @(negedge clk);
            penable = 1'b1;
            for (k = 0; k < ACCESS_CYCLES_MAX && !pready; k = k + 1)
                @(negedge clk);
            check("pready, back to back", {47'd0, pready}, 48'd1);
            check("wait states", {47'd0, k > 0}, 48'd1);
            answer = prdata;
            @(negedge clk);
        end
    endtask

    // Transfers without a pause; nothing happens without psel. At the word that is free for the host.
    task bus_limits;
        begin
            @(negedge clk);
            follows(1'b1, CARD_CONFIG_HOLD, 32'hA1B2C300);
            follows(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word, back to back", answer, 32'hA1B2C300);
            follows(1'b1, CARD_CONFIG_HOLD, 32'h4D5E6F00);
            follows(1'b1, CARD_CONFIG_TRIGGER_PERIOD, 32'h00345678);
            follows(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word of the first of two writes", answer, 32'h4D5E6F00);
            follows(1'b0, CARD_CONFIG_TRIGGER_PERIOD, 32'd0);
            check("word of the second of two writes", answer, 32'h00345678);
            // Another slave's transfer.
            psel = 1'b0;
            penable = 1'b1;
            pwrite = 1'b1;
            paddr = {CARD_CONFIG_HOLD[10:0], 2'b00};
            pwdata = 32'hFFFFFF00;
            repeat (ACCESS_CYCLES_MAX)
                @(negedge clk);
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after another slave's transfer", answer, 32'h4D5E6F00);
            transfer(1'b1, CARD_CONFIG_HOLD, 32'd0);
        end
    endtask
